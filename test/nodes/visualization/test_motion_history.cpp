#include "nodes/visualization/motion_history.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Motion that shifts the core by as many millimetres as the step has. */
MotionState motionOf(std::uint64_t step)
{
  MotionState message;
  message.step = step;
  message.axis.z = 1.0;
  message.length = 0.1;
  message.fade_core = 0.05;
  message.fade_reach = 0.1;
  message.shift.x = 1e-3 * static_cast<double>(step);
  return message;
}

/** Shift of a map in millimetres. */
double shiftOf(const motion::MotionMap& map)
{
  return 1e3 * map.displacement(Eigen::Vector3d::Zero()).x();
}

TEST(MotionHistory, KnowsTheMapOfEachOfTheLastSteps)
{
  MotionHistory history;
  EXPECT_TRUE(history.empty());
  for (std::uint64_t step = 1; step <= MotionHistory::kCapacity + 1; ++step)
    history.add(motionOf(step));
  ASSERT_NE(history.find(2), nullptr);
  EXPECT_NEAR(shiftOf(*history.find(2)), 2.0, 1e-9);
  EXPECT_EQ(history.find(1), nullptr) << "the oldest one is forgotten";
  EXPECT_EQ(history.find(100), nullptr);
  EXPECT_EQ(history.newest().step, MotionHistory::kCapacity + 1);
}

TEST(MotionHistory, FindsTheNearestStep)
{
  MotionHistory history;
  EXPECT_TRUE(history.nearest(7).resting()) << "at rest without a motion";
  for (const std::uint64_t step : {4U, 20U, 36U})
    history.add(motionOf(step));
  EXPECT_NEAR(shiftOf(history.nearest(0)), 4.0, 1e-9);
  EXPECT_NEAR(shiftOf(history.nearest(13)), 20.0, 1e-9);
  EXPECT_NEAR(shiftOf(history.nearest(11)), 4.0, 1e-9);
  EXPECT_NEAR(shiftOf(history.nearest(99)), 36.0, 1e-9);
}

TEST(MotionHistory, BeginsAgainWithAnEarlierStep)
{
  MotionHistory history;
  history.add(motionOf(40));
  history.add(motionOf(50));
  history.add(motionOf(3));
  EXPECT_EQ(history.find(40), nullptr);
  EXPECT_NEAR(shiftOf(history.nearest(50)), 3.0, 1e-9);
}

TEST(MotionHistory, RefusesAnImpossibleMotionAndKeepsTheOthers)
{
  MotionHistory history;
  history.add(motionOf(4));
  MotionState broken = motionOf(5);
  broken.twist = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(history.add(broken), InputError);
  EXPECT_NE(history.find(4), nullptr);
  EXPECT_EQ(history.find(5), nullptr);
}

TEST(RestingMap, ReturnsItsArgument)
{
  const Eigen::Vector3d point(0.1, -0.2, 0.3);
  EXPECT_EQ(restingMap().position(point), point);
  EXPECT_EQ(restingMap().pullBack(point), point);
  EXPECT_TRUE(restingMap().resting());
}

}  // namespace
}  // namespace endovascular_sim::nodes
