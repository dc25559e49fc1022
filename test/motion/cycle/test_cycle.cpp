#include "motion/cycle/cycle.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/archive_checks.h"

namespace endovascular_sim::motion
{
namespace
{

TEST(Cycle, CountsItsCyclesAtItsRate)
{
  Cycle cycle(1.25);
  for (int k = 0; k < 100000; ++k)
    cycle.advance(1e-3);
  EXPECT_NEAR(cycle.count() + cycle.phase(), 125.0, 1e-8);
}

TEST(Cycle, TakesANewRateFromTheNextCycleOn)
{
  Cycle cycle(1.0);
  cycle.advance(0.5);
  cycle.setRate(2.0);
  cycle.advance(0.25);
  EXPECT_DOUBLE_EQ(cycle.phase(), 0.75);
  EXPECT_EQ(cycle.rate(), 1.0);
  cycle.advance(0.375);
  EXPECT_DOUBLE_EQ(cycle.phase(), 0.25);  // 0.125 s of the new cycle
  EXPECT_EQ(cycle.rate(), 2.0);
}

TEST(Cycle, IsHeldAtItsEndUntilItIsLetGo)
{
  Cycle cycle(0.25);
  cycle.advance(1.0);
  cycle.hold(true);
  cycle.advance(2.0);
  EXPECT_DOUBLE_EQ(cycle.phase(), 0.75);
  EXPECT_FALSE(cycle.standing());
  for (int k = 0; k < 10; ++k)
    cycle.advance(1.5);
  EXPECT_EQ(cycle.phase(), 0.0);
  EXPECT_TRUE(cycle.standing());
  EXPECT_EQ(cycle.speed(), 0.0);
  EXPECT_EQ(cycle.count(), 1U);
  cycle.hold(false);
  cycle.advance(1.0);
  EXPECT_DOUBLE_EQ(cycle.phase(), 0.25);
  EXPECT_EQ(cycle.speed(), 0.25);
}

TEST(Cycle, IsHeldAtOnceBeforeItHasBegun)
{
  Cycle cycle(0.25);
  cycle.hold(true);
  EXPECT_EQ(cycle.speed(), 0.0);
  cycle.advance(1.0);
  EXPECT_EQ(cycle.phase(), 0.0);
  cycle.hold(false);
  cycle.advance(1.0);
  EXPECT_DOUBLE_EQ(cycle.phase(), 0.25);
}

TEST(Cycle, GoesOnFromASavedStateWithTheSameBits)
{
  Cycle cycle(1.1);
  cycle.setRate(1.7);
  for (int k = 0; k < 700; ++k)
    cycle.advance(1e-3);
  Archive saved;
  saved(cycle);
  Cycle loaded(0.5);
  Archive reader(saved.bytes());
  reader(loaded);
  EXPECT_TRUE(reader.atEnd());
  for (int k = 0; k < 3000; ++k)
  {
    cycle.advance(1e-3);
    loaded.advance(1e-3);
    ASSERT_EQ(cycle.phase(), loaded.phase());
  }
  EXPECT_EQ(cycle.count(), loaded.count());
}

TEST(Cycle, IsRefusedFromAStateThatNoCycleHas)
{
  for (const double phase : {-0.1, 1.0, std::nan(""), std::numeric_limits<double>::infinity()})
  {
    Cycle wrong(1.0), loaded(1.0);
    wrong.set(phase, 1.0);
    Archive saved;
    saved(wrong);
    Archive reader(saved.bytes());
    EXPECT_THROW(reader(loaded), ArchiveError) << phase;
  }
}

}  // namespace
}  // namespace endovascular_sim::motion
