#include "common/phase_timer.h"

#include <gtest/gtest.h>

namespace endovascular_sim
{
namespace
{

/** Busy for a time [s]. */
void spend(double seconds)
{
  const auto begin = PhaseTimer::Clock::now();
  while (std::chrono::duration<double>(PhaseTimer::Clock::now() - begin).count() < seconds)
  {
  }
}

double sumOf(const PhaseTimer& timer)
{
  double sum = 0.0;
  for (std::size_t phase = 0; phase < kPhaseCount; ++phase)
    sum += timer.seconds(static_cast<Phase>(phase));
  return sum;
}

}  // namespace

TEST(PhaseTimer, CountsAnInnerPhaseTowardsItselfOnly)
{
  PhaseTimer timer;
  const auto begin = PhaseTimer::Clock::now();
  {
    PhaseTimer::Scope outer(timer, Phase::kControl);
    spend(2e-3);
    {
      PhaseTimer::Scope inner(timer, Phase::kSolve);
      spend(3e-3);
    }
    spend(1e-3);
  }
  const double whole = std::chrono::duration<double>(PhaseTimer::Clock::now() - begin).count();
  EXPECT_GE(timer.seconds(Phase::kControl), 3e-3);
  EXPECT_GE(timer.seconds(Phase::kSolve), 3e-3);
  EXPECT_LE(sumOf(timer), whole);
  EXPECT_EQ(timer.entries(Phase::kControl), 1);
  EXPECT_EQ(timer.entries(Phase::kSolve), 1);
  EXPECT_EQ(timer.seconds(Phase::kTwist), 0.0);
}

TEST(PhaseTimer, CountsNothingOutsideOfItsGuards)
{
  PhaseTimer timer;
  {
    PhaseTimer::Scope scope(timer, Phase::kTwist);
  }
  const double before = sumOf(timer);
  spend(1e-3);
  {
    PhaseTimer::Scope scope(timer, Phase::kSampling);
  }
  EXPECT_EQ(timer.seconds(Phase::kTwist), before);
  timer.reset();
  EXPECT_EQ(sumOf(timer), 0.0);
}

}  // namespace endovascular_sim
