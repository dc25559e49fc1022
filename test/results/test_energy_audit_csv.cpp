#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "results/energy_audit_csv.h"

namespace endovascular_sim::results
{

namespace
{

/** Closure of seconds with given errors and turnovers [J]. */
AuditClosure closureOf(const std::vector<std::pair<double, double>>& seconds)
{
  AuditClosure closure;
  rod::EnergyBalance balance;
  double time = 0.0;
  for (const auto& [error, turnover] : seconds)
  {
    time += 1.0;
    balance.push += turnover;
    balance.bending += turnover - error;
    balance.turnover += turnover;
    closure.add(time - 0.5, balance);
    closure.add(time, balance);
  }
  return closure;
}

}  // namespace

TEST(AuditClosure, ComparesTheErrorOfEverySecondWithItsTurnoverAndTheMeanOfAllSeconds)
{
  const AuditClosure closure = closureOf({{0.0, 1.0}, {-0.04, 2.0}, {0.0, 0.0}});
  EXPECT_NEAR(closure.worst(), 0.04 / (0.02 * 2.0 + 0.01 * 3.0 / 3.0), 1e-12);
  EXPECT_EQ(closure.worstSecond(), 1);
  EXPECT_NEAR(closure.shareOfRun(), 0.04 / 3.0, 1e-12);
}

// In a run of a hundred seconds, a whole second without explanation was within 1 % of the run's turnover.
TEST(AuditClosure, ASecondWhoseWorkNothingExplainsIsRefusedInALongRun)
{
  std::vector<std::pair<double, double>> seconds(200, {0.0, 1.0});
  EXPECT_TRUE(closureOf(seconds).accepted());
  seconds[41].first = 0.8;
  const AuditClosure closure = closureOf(seconds);
  EXPECT_LT(closure.shareOfRun(), AuditClosure::kShareOfRun);
  EXPECT_GT(closure.worst(), 1.0);
  EXPECT_FALSE(closure.accepted());
  const std::string text = closure.text();
  EXPECT_NE(text.find("beyond"), std::string::npos) << text;
  EXPECT_NE(text.find("share 80 % of the turnover of second 42"), std::string::npos) << text;
  EXPECT_NE(text.find("in sum 0.4 % of the run's 200 J"), std::string::npos) << text;
}

TEST(AuditClosure, SmallErrorsOfManySecondsAreRefusedInSum)
{
  const std::vector<std::pair<double, double>> of_both_signs = {{0.015, 1.0}, {-0.015, 1.0}, {0.015, 1.0}};
  const AuditClosure closure = closureOf(of_both_signs);
  EXPECT_LT(closure.worst(), 1.0);
  EXPECT_NEAR(closure.shareOfRun(), 0.015, 1e-12);
  EXPECT_FALSE(closure.accepted());
  EXPECT_TRUE(closureOf({{0.009, 1.0}, {-0.009, 1.0}, {0.009, 1.0}}).accepted());
}

TEST(AuditClosure, SecondsBeforeALoadedStateDoNotCount)
{
  AuditClosure closure;
  rod::EnergyBalance balance;
  balance.push = balance.turnover = 1.0;
  balance.bending = 0.97;
  closure.add(41.2, balance);
  EXPECT_EQ(closure.worstSecond(), 41);
  EXPECT_NEAR(closure.worst(), 1.0, 1e-12);
}

TEST(AuditClosure, OfABalanceWithoutErrorIsZero)
{
  AuditClosure closure;
  closure.add(0.3, rod::EnergyBalance());
  EXPECT_EQ(closure.worst(), 0.0);
  EXPECT_TRUE(closure.accepted());
}

TEST(EnergyBalance, SumsContainEveryTermOnce)
{
  rod::EnergyBalance balance;
  for (const rod::BalanceTerm& term : rod::kBalanceTerms)
    balance.*term.value = 1.0;
  EXPECT_EQ(balance.work(), 6.0);
  EXPECT_EQ(balance.stored(), 6.0);
  EXPECT_EQ(balance.dissipated(), 6.0);
  // All terms but configurational, turn_error and turnover belong to one of the sums.
  EXPECT_EQ(balance.numerical(), static_cast<double>(rod::kBalanceTerms.size()) - 3.0 - 18.0);
}

}  // namespace endovascular_sim::results
