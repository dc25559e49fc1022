#include "rviz_plugin/model/motion_follower.h"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "test/rviz_plugin/moved_patient.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kFrame = 1.0 / 30.0;

RodStateVisualConstPtr wireOf(std::uint64_t step)
{
  const auto message = boost::make_shared<RodStateVisual>();
  message->step = step;
  return message;
}

/** Shift of the patient [mm], equal to the share of motionMessage(). */
double shiftOf(const MotionFollower& follower)
{
  return 1e3 * follower.map().displacement(Eigen::Vector3d::Zero()).x();
}

TEST(MotionFollower, WithoutMotionsAStateIsShownAtOnceInAPatientAtRest)
{
  MotionFollower follower;
  EXPECT_FALSE(follower.advance(kFrame));
  follower.add(wireOf(3));
  EXPECT_TRUE(follower.advance(0.0));
  EXPECT_EQ(follower.wire()->step, 3U);
  EXPECT_TRUE(follower.map().resting());
  EXPECT_FALSE(follower.advance(kFrame)) << "nothing new";
}

TEST(MotionFollower, AStateWaitsForTheMotionOfItsOwnStep)
{
  MotionFollower follower;
  follower.add(motionMessage(10, 1.0));
  follower.add(wireOf(10));
  EXPECT_TRUE(follower.advance(kFrame));
  follower.add(wireOf(11));
  EXPECT_FALSE(follower.advance(kFrame));
  EXPECT_EQ(follower.wire()->step, 10U);
  EXPECT_NEAR(shiftOf(follower), 1.0, 1e-9);
  follower.add(motionMessage(11, 0.5));
  EXPECT_TRUE(follower.advance(kFrame));
  EXPECT_EQ(follower.wire()->step, 11U);
  EXPECT_NEAR(shiftOf(follower), 0.5, 1e-9);
}

TEST(MotionFollower, ALaterMotionDoesNotMoveTheShownState)
{
  MotionFollower follower;
  follower.add(motionMessage(10, 1.0));
  follower.add(motionMessage(11, 0.5));
  follower.add(wireOf(10));
  EXPECT_TRUE(follower.advance(kFrame));
  EXPECT_NEAR(shiftOf(follower), 1.0, 1e-9);
  follower.add(motionMessage(12, 0.2));
  EXPECT_FALSE(follower.advance(kFrame));
  EXPECT_NEAR(shiftOf(follower), 1.0, 1e-9);
}

TEST(MotionFollower, AfterAJumpAStateIsShownWithTheNearestMotion)
{
  MotionFollower follower;
  follower.add(motionMessage(500, 1.0));
  follower.add(wireOf(500));
  follower.advance(kFrame);
  // The player of a recording shows the last messages before a time: here the motion is that of the next step.
  follower.add(motionMessage(101, 0.4));
  follower.add(wireOf(100));
  double waited = 0.0;
  while (!follower.advance(kFrame))
    ASSERT_LE(waited += kFrame, MotionFollower::kPatience);
  EXPECT_EQ(follower.wire()->step, 100U);
  EXPECT_NEAR(shiftOf(follower), 0.4, 1e-9);
  EXPECT_GT(waited, 0.0) << "the own motion may still come";
}

TEST(MotionFollower, ASlowFrameShowsTheNewestStateWithItsMotion)
{
  MotionFollower follower;
  for (std::uint64_t step = 0; step < 16; ++step)
  {
    follower.add(motionMessage(step, 0.01 * static_cast<double>(step)));
    follower.add(wireOf(step));
  }
  follower.add(motionMessage(16, 0.9));
  EXPECT_TRUE(follower.advance(0.25));
  EXPECT_EQ(follower.wire()->step, 15U);
  EXPECT_NEAR(shiftOf(follower), 0.15, 1e-9);
}

TEST(MotionFollower, ThePatientRestsWhenTheMotionHasEnded)
{
  MotionFollower follower;
  follower.add(motionMessage(1, 1.0));
  follower.add(wireOf(1));
  follower.advance(kFrame);
  for (std::uint64_t step = 2; step <= MotionFollower::kMostWithout + 2; ++step)
  {
    EXPECT_FALSE(follower.map().resting());
    follower.add(wireOf(step));
    follower.advance(1.0);
  }
  EXPECT_TRUE(follower.map().resting());
}

TEST(MotionFollower, TheVesselMovesBeforeTheFirstState)
{
  MotionFollower follower;
  follower.add(motionMessage(1, 1.0));
  EXPECT_TRUE(follower.advance(kFrame));
  EXPECT_NEAR(shiftOf(follower), 1.0, 1e-9);
  EXPECT_FALSE(follower.wire());
  EXPECT_FALSE(follower.advance(kFrame)) << "nothing new";
}

TEST(MotionFollower, ClearedStatesDoNotReturn)
{
  MotionFollower follower;
  follower.add(motionMessage(1, 1.0));
  follower.add(wireOf(1));
  follower.advance(kFrame);
  follower.add(wireOf(2));
  follower.clearWires();
  EXPECT_FALSE(follower.wire());
  follower.advance(1.0);
  EXPECT_FALSE(follower.wire());
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
