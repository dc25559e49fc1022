#include "nodes/fluoroscopy/body_motion_history.h"

#include <gtest/gtest.h>

#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::nodes
{
namespace
{

using fluoroscopy::motionAt;

TEST(BodyMotionHistory, HoldsTheMotionOfEveryLateStep)
{
  BodyMotionHistory history;
  EXPECT_TRUE(history.at(7).resting());
  for (std::uint64_t k = 0; k < 200; ++k)
    history.add(16 * k, motionAt(0.004 * static_cast<double>(k), 0.1));
  EXPECT_EQ(history.at(16 * 190), motionAt(0.004 * 190, 0.1));
  EXPECT_EQ(history.at(16 * 190 + 15), motionAt(0.004 * 190, 0.1));  // that of this step has not arrived
  EXPECT_EQ(history.at(16 * 500), motionAt(0.004 * 199, 0.1));
  EXPECT_EQ(history.at(16), motionAt(0.004 * (200 - BodyMotionHistory::kSteps), 0.1));  // forgotten: the oldest
}

TEST(BodyMotionHistory, ForgetsLaterStepsAfterAStepBack)
{
  BodyMotionHistory history;
  for (std::uint64_t k = 0; k < 10; ++k)
    history.add(k, motionAt(0.1, 0.01 * static_cast<double>(k)));
  history.add(4, motionAt(0.6, 0.0));
  EXPECT_EQ(history.at(9), motionAt(0.6, 0.0));
  EXPECT_EQ(history.at(3), motionAt(0.1, 0.03));
}

}  // namespace
}  // namespace endovascular_sim::nodes
