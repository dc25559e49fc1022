#include "rviz_plugin/model/motion_monitor.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/rviz_plugin/moved_patient.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

TEST(MotionMonitor, KnowsNothingInAPatientAtRest)
{
  MotionMonitor monitor;
  monitor.countWire();
  EXPECT_FALSE(monitor.status().has_value());
  const Eigen::Vector3d tip(1e-3, 2e-3, 3e-3);
  EXPECT_EQ(monitor.pullBack(tip), tip);
}

TEST(MotionMonitor, ShowsThePresentRatesUntilTheControlsAreKnown)
{
  MotionMonitor monitor;
  MotionState motion = motionMessage(1);
  motion.systole = 1;
  motion.breath_held = 1;
  monitor.add(motion);
  ASSERT_TRUE(monitor.status().has_value());
  EXPECT_EQ(monitor.status()->controls.heart_rate, 1.2);
  EXPECT_TRUE(monitor.status()->controls.breath_held);
  EXPECT_TRUE(monitor.status()->systole);
  EXPECT_TRUE(monitor.status()->is_holding);
  MotionControls controls;
  controls.heart_rate = 1.5;
  controls.breathing_rate = 0.2;
  monitor.add(controls);
  EXPECT_EQ(monitor.status()->controls.heart_rate, 1.5);
  monitor.add(motion);
  EXPECT_EQ(monitor.status()->controls.heart_rate, 1.5) << "from the next beat on";
  EXPECT_EQ(monitor.status()->heart_rate, 1.2) << "of the present beat";
  EXPECT_FALSE(monitor.status()->controls.breath_held);
  EXPECT_TRUE(monitor.status()->is_holding) << "until the next breath";
}

TEST(MotionMonitor, PullsTheTipBack)
{
  MotionMonitor monitor;
  monitor.add(motionMessage(1));
  const Eigen::Vector3d rest(1e-3, 2e-3, 3e-3), moved = movedPatient().position(rest);
  EXPECT_GT((moved - rest).norm(), 5e-4);
  EXPECT_LT((monitor.pullBack(moved) - rest).norm(), 1e-12);
}

TEST(MotionMonitor, ForgetsAMotionThatHasEnded)
{
  MotionMonitor monitor;
  monitor.add(motionMessage(1));
  for (int k = 0; k < MotionMonitor::kMostWithout; ++k)
    monitor.countWire();
  EXPECT_TRUE(monitor.status().has_value());
  monitor.countWire();
  EXPECT_FALSE(monitor.status().has_value());
}

TEST(MotionMonitor, RefusesWhatIsNoNumber)
{
  MotionMonitor monitor;
  MotionState motion = motionMessage(1);
  motion.heart_rate = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(monitor.add(motion), InputError);
  EXPECT_FALSE(monitor.status().has_value());
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
