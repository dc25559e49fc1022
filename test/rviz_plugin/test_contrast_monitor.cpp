#include "rviz_plugin/model/contrast_monitor.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

ContrastState state(double syringe)
{
  ContrastState message;
  message.syringe = syringe;
  message.volume = 12e-6 - syringe;
  return message;
}

TEST(ContrastMonitor, KeepsTheNewestState)
{
  ContrastMonitor monitor;
  EXPECT_FALSE(monitor.status());
  monitor.add(state(9e-6));
  monitor.add(state(6e-6));
  EXPECT_EQ(monitor.status()->syringe, 6e-6);
  EXPECT_EQ(monitor.status()->volume, 12e-6 - 6e-6);
}

TEST(ContrastMonitor, ForgetsASceneThatHasEnded)
{
  ContrastMonitor monitor;
  monitor.add(state(9e-6));
  for (int k = 0; k < ContrastMonitor::kMostWithout; ++k)
    monitor.countWire();
  EXPECT_TRUE(monitor.status());
  monitor.countWire();
  EXPECT_FALSE(monitor.status());
}

TEST(ContrastMonitor, RefusesImpossibleNumbers)
{
  ContrastMonitor monitor;
  EXPECT_THROW(monitor.add(state(std::numeric_limits<double>::quiet_NaN())), InputError);
  EXPECT_THROW(monitor.add(state(-1e-6)), InputError);
  EXPECT_FALSE(monitor.status());
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
