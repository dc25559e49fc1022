#include "benchmark/studies/hard_case.h"

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

TEST(HardCase, BaselineIsGood)
{
  const Verdict verdict = judge(HardCase(), 400);
  EXPECT_EQ(verdict.word, "good") << verdict.reason;
  EXPECT_EQ(verdict.steps, 400);
}

TEST(HardCase, IsBadIfTheWireLeavesThroughTheWall)
{
  HardCase hard;
  hard.scheme = "paper";
  const Verdict verdict = judge(hard, 1700);
  EXPECT_EQ(verdict.word, "bad");
  EXPECT_NE(verdict.reason.find("outside"), std::string::npos) << verdict.reason;
}

TEST(HardCase, IsRejectedWithTheReasonOfTheScene)
{
  HardCase hard;
  hard.nodes = 3;
  const Verdict verdict = judge(hard, 10);
  EXPECT_EQ(verdict.word, "rejected");
  EXPECT_NE(verdict.reason.find("introducer"), std::string::npos) << verdict.reason;
}

TEST(HardCase, RecoversFromAPerturbedState)
{
  HardCase hard;
  hard.perturbation = 0.3e-3;
  EXPECT_EQ(judge(hard, 400).word, "good");
  hard.perturbation = 0.0;
  hard.fold_angle = 0.2;
  EXPECT_EQ(judge(hard, 400).word, "good");
}

TEST(HardCase, IsReproducible)
{
  HardCase hard;
  hard.speed = 0.2;
  const Verdict first = judge(hard, 200);
  const Verdict second = judge(hard, 200);
  EXPECT_EQ(first.max_strain, second.max_strain);
  EXPECT_EQ(first.energy_excess, second.energy_excess);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
