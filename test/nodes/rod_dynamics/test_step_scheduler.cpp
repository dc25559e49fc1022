#include "nodes/rod_dynamics/step_scheduler.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kStep = 1e-3;  // s

/** A loop whose clock only moves by what its steps take. */
struct Loop
{
  StepScheduler pace{kStep};
  StepScheduler::Clock::time_point start;
  StepScheduler::Clock::time_point now = start;
  int let_go = 0;

  Loop() { pace.start(now); }

  /** @param seconds that the step takes @return when it began, from the start on [s] */
  double step(double seconds)
  {
    now = std::max(now, pace.next());
    pace.begin(now);
    const double began = std::chrono::duration<double>(now - start).count();
    now += StepScheduler::period(seconds);
    let_go += pace.end(now);
    return began;
  }
};

TEST(StepScheduler, BeginsEveryStepAtItsTime)
{
  Loop loop;
  for (int k = 0; k < 100; ++k)
    EXPECT_NEAR(loop.step(0.3e-3), k * kStep, 1e-9);
}

TEST(StepScheduler, CatchesUpWhatWasLostAQuarterFasterAndThenKeepsTheTimeAgain)
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
  EXPECT_EQ(loop.let_go, 0);
}

TEST(StepScheduler, LetsGoWhatIsMoreThanHalfASecond)
{
  Loop loop;
  loop.step(0.7);
  EXPECT_EQ(loop.let_go, 1);
  EXPECT_NEAR(loop.step(0.3e-3), 0.7, 1e-9);
  EXPECT_NEAR(loop.step(0.3e-3), 0.7 + kStep, 1e-9) << "nothing is made up for";
}

TEST(StepScheduler, RunsAsFastAsItCanWhileItsStepsTakeTooLong)
{
  Loop loop;
  for (int k = 0; k < 100; ++k)
    EXPECT_NEAR(loop.step(1.1e-3), k * 1.1e-3, 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::nodes
