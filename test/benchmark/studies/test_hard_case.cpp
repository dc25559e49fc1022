#include "benchmark/studies/hard_case.h"

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

TEST(HardCase, IsGoodWhereTheWireIsOrdinary)
{
  const Verdict verdict = judge(HardCase(), 400);
  EXPECT_EQ(verdict.word, "good") << verdict.reason;
  EXPECT_EQ(verdict.steps, 400);
}

TEST(HardCase, IsBadWhereTheSchemeLetsTheWireThroughTheWall)
{
  HardCase hard;
  hard.scheme = "paper";
  const Verdict verdict = judge(hard, 1700);
  EXPECT_EQ(verdict.word, "bad");
  EXPECT_NE(verdict.reason.find("outside"), std::string::npos) << verdict.reason;
}

TEST(HardCase, IsRefusedWithAReasonWhereTheSceneIs)
{
  HardCase hard;
  hard.nodes = 3;
  const Verdict verdict = judge(hard, 10);
  EXPECT_EQ(verdict.word, "refused");
  EXPECT_NE(verdict.reason.find("introducer"), std::string::npos) << verdict.reason;
}

TEST(HardCase, RecoversFromADisturbedState)
{
  HardCase hard;
  hard.disturbance = 0.3e-3;
  EXPECT_EQ(judge(hard, 400).word, "good");
  hard.disturbance = 0.0;
  hard.nearly_folded = 0.2;
  EXPECT_EQ(judge(hard, 400).word, "good");
}

TEST(HardCase, GivesTheSameVerdictTwice)
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
