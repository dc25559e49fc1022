#include <gtest/gtest.h>

#include "results/energy_audit_csv.h"

namespace endovascular_sim::results
{

TEST(AuditClosure, ComparesTheErrorOfEverySecondWithTheWorkOfTheSecondAndOfTheRun)
{
  AuditClosure closure;
  rod::EnergyBalance balance;
  balance.push = balance.bending = balance.turnover = 1.0;
  closure.add(0.5, balance);
  closure.add(1.0, balance);
  balance.push = balance.turnover = 3.0;
  balance.bending = 2.96;  // error 0.04 J of 2 J in the second second, 3 J in the run
  closure.add(2.0, balance);
  EXPECT_NEAR(closure.worst(), 0.04 / (0.02 * 2.0 + 0.01 * 3.0), 1e-12);
  EXPECT_EQ(closure.worstSecond(), 1);
}

TEST(AuditClosure, OfABalanceWithoutErrorIsZero)
{
  AuditClosure closure;
  closure.add(0.3, rod::EnergyBalance());
  EXPECT_EQ(closure.worst(), 0.0);
}

TEST(EnergyBalance, SumsContainEveryTermOnce)
{
  rod::EnergyBalance balance;
  for (const rod::BalanceTerm& term : rod::kBalanceTerms)
    balance.*term.value = 1.0;
  EXPECT_EQ(balance.work(), 4.0);
  EXPECT_EQ(balance.stored(), 6.0);
  EXPECT_EQ(balance.dissipated(), 6.0);
  // All terms but configurational, turn_error and turnover belong to one of the sums.
  EXPECT_EQ(balance.numerical(), static_cast<double>(rod::kBalanceTerms.size()) - 3.0 - 16.0);
}

}  // namespace endovascular_sim::results
