#include "nodes/rod_dynamics/control/rt_throttle_guard.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(RtThrottleGuard, GrantsTheIdleShareInAnOverloadedLoop)
{
  RtThrottleGuard guard(0.06, 1e-3);
  double busy = 0.0;
  double rest = 0.0;
  for (int k = 0; k < 20000; ++k)
  {
    busy += 1.1e-3;
    rest += guard.after(0.0, 1.1e-3);
    EXPECT_GE(rest, 0.06 * busy - 1.1e-3);
  }
  EXPECT_NEAR(rest / busy, 0.06, 0.001);
}

TEST(RtThrottleGuard, RequestsNoSleepInALoopWithEnoughIdleTime)
{
  RtThrottleGuard guard(0.06, 1e-3);
  for (int k = 0; k < 20000; ++k)
    EXPECT_EQ(guard.after(0.07e-3, 0.93e-3), 0.0);
  for (int k = 0; k < 15; ++k)
    EXPECT_EQ(guard.after(0.0, 1e-3), 0.0) << "a few long steps do not exhaust the idle time";
  for (int k = 0; k < 100; ++k)
    EXPECT_EQ(guard.after(0.5e-3, 0.5e-3), 0.0);
}

TEST(RtThrottleGuard, RequestsNoSleepWithoutALimit)
{
  RtThrottleGuard guard(0.0, 1e-3);
  for (int k = 0; k < 20000; ++k)
    EXPECT_EQ(guard.after(0.0, 1e-3), 0.0);
}

}  // namespace
}  // namespace endovascular_sim::nodes
