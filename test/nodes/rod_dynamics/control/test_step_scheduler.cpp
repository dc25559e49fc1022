#include "nodes/rod_dynamics/control/step_scheduler.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{
constexpr double kStep = 1e-3;  ///< [s]

/** Loop with a simulated clock that advances by the durations of the steps. */
struct Loop
{
  StepScheduler scheduler{kStep};
  StepScheduler::Clock::time_point start;
  StepScheduler::Clock::time_point now = start;
  int discarded = 0;

  Loop() { scheduler.start(now); }

  /** @param seconds duration of the step [s] @return start time of the step [s] */
  double step(double seconds)
  {
    now = std::max(now, scheduler.next());
    scheduler.begin(now);
    const double began = std::chrono::duration<double>(now - start).count();
    now += StepScheduler::period(seconds);
    discarded += scheduler.end(now);
    return began;
  }
};

TEST(StepScheduler, StartsEveryStepInItsSlot)
{
  Loop loop;
  for (int k = 0; k < 100; ++k)
    EXPECT_NEAR(loop.step(0.3e-3), k * kStep, 1e-9);
}

TEST(StepScheduler, CatchesUpAQuarterFasterThanRealTime)
{
  Loop loop;
  loop.step(41e-3);
  double before = loop.step(0.3e-3);
  EXPECT_NEAR(before, 41e-3, 1e-9);
  for (int k = 2; k < 300; ++k)
  {
    const double began = loop.step(0.3e-3);
    EXPECT_GE(began - before, kStep / 1.25 - 1e-9) << k;
    before = began;
    if (k > 202)  // 40 ms at 0.2 ms for each
    {
      EXPECT_NEAR(began, k * kStep, 1e-9);
    }
  }
  EXPECT_EQ(loop.discarded, 0);
}

TEST(StepScheduler, DiscardsABacklogOfMoreThanHalfASecond)
{
  Loop loop;
  loop.step(0.7);
  EXPECT_EQ(loop.discarded, 1);
  EXPECT_NEAR(loop.step(0.3e-3), 0.7, 1e-9);
  EXPECT_NEAR(loop.step(0.3e-3), 0.7 + kStep, 1e-9) << "no catching up";
}

TEST(StepScheduler, RunsWithoutPauseWhileStepsAreLongerThanTheirSlots)
{
  Loop loop;
  for (int k = 0; k < 100; ++k)
    EXPECT_NEAR(loop.step(1.1e-3), k * 1.1e-3, 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::nodes
