#include "robot/backlash.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::robot
{
namespace
{

constexpr double kPlay = 0.2;

/** Triangle wave from 0 to @p top and back, of period 2. */
double triangle(double t, double top)
{
  const double phase = std::fmod(t, 2.0);
  return top * (phase < 1.0 ? phase : 2.0 - phase);
}

/** Closed form of the play operator under triangle(): it begins centred, is driven up with half of the play between,
 *  stays while the play is crossed, and is driven down with half of the play on the other side. */
double drivenByTriangle(double t, double top)
{
  const double x = triangle(t, top);
  const bool rises = std::fmod(t, 2.0) < 1.0;
  const double half = 0.5 * kPlay;
  if (t < 1.0)
    return std::max(0.0, x - half);
  return rises ? std::max(half, x - half) : std::min(top - half, x + half);
}

TEST(Backlash, FollowsATriangleWaveAsTheClosedForm)
{
  double driven = 0.0;
  for (int k = 0; k <= 6000; ++k)
  {
    const double t = 1e-3 * k;
    driven = drivenAfterPlay(driven, triangle(t, 1.0), kPlay);
    ASSERT_NEAR(driven, drivenByTriangle(t, 1.0), 1e-12) << t;
  }
}

TEST(Backlash, TheDrivenSideIsIndependentOfTheStepOfAMonotoneMotion)
{
  const double in_one_step = drivenAfterPlay(0.0, 0.73, kPlay);
  double in_many = 0.0;
  for (int k = 1; k <= 1000; ++k)
    in_many = drivenAfterPlay(in_many, 0.73 * k / 1000, kPlay);
  EXPECT_EQ(in_many, in_one_step);
}

TEST(Backlash, MotionsInsideOfThePlayMoveNothing)
{
  double driven = 0.5;
  for (int k = 0; k < 1000; ++k)
  {
    driven = drivenAfterPlay(driven, 0.5 + 0.49 * kPlay * std::sin(0.1 * k), kPlay);
    ASSERT_EQ(driven, 0.5);
  }
}

TEST(Backlash, AReversalCostsTheWholePlay)
{
  double driven = drivenAfterPlay(0.0, 1.0, kPlay);
  EXPECT_EQ(driven, 1.0 - 0.5 * kPlay);
  driven = drivenAfterPlay(driven, 1.0 - 0.99 * kPlay, kPlay);
  EXPECT_EQ(driven, 1.0 - 0.5 * kPlay);
  driven = drivenAfterPlay(driven, 1.0 - 1.5 * kPlay, kPlay);
  EXPECT_NEAR(driven, 1.0 - kPlay, 1e-15);
}

TEST(Backlash, WithoutPlayBothSidesAreEqual)
{
  for (const double x : {0.1, -0.3, 1e-9, 0.1 + 0.2})
  {
    EXPECT_EQ(drivenAfterPlay(0.7, x, 0.0), x);
    EXPECT_EQ(drivingAfterPlay(0.7, x, 0.0), x);
  }
}

TEST(Backlash, TheDrivingSideIsRecoveredFromTheDrivenOne)
{
  double driven = 0.0;
  for (int k = 0; k <= 4000; ++k)
  {
    const double driving = triangle(1e-3 * k, 1.0);
    driven = drivenAfterPlay(driven, driving, kPlay);
    ASSERT_NEAR(drivingAfterPlay(driving, driven, kPlay), driving, 1e-15) << "the instrument followed";
  }
  EXPECT_NEAR(drivingAfterPlay(0.8, 0.5, kPlay), 0.6, 1e-15) << "the instrument stopped at 0.5";
}

TEST(Backlash, IsEngagedAtTheEndsOfThePlayOnly)
{
  EXPECT_TRUE(isEngaged(0.0, 0.1, kPlay, 1.0));
  EXPECT_FALSE(isEngaged(0.0, 0.1, kPlay, -1.0));
  EXPECT_FALSE(isEngaged(0.0, 0.05, kPlay, 1.0));
  EXPECT_TRUE(isEngaged(0.0, -0.1, kPlay, -1.0));
  EXPECT_TRUE(isEngaged(0.3, 0.3, 0.0, 1.0)) << "without play, always";
}

}  // namespace
}  // namespace endovascular_sim::robot
