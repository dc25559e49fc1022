#include "nodes/rod_dynamics/control/late_steps.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kSlot = 1e-3;
constexpr auto kSimulation = static_cast<std::size_t>(LoopPhase::kSimulation);
constexpr auto kTransport = static_cast<std::size_t>(LoopPhase::kTransport);
constexpr auto kPublishing = static_cast<std::size_t>(LoopPhase::kPublishing);

/** Step of 0.5 ms, of which all but the transport is processor time. */
LoopTimes usualStep()
{
  LoopTimes times;
  times.wall[kSimulation] = times.processor[kSimulation] = 3e-4;
  times.wall[kTransport] = 1.5e-4;
  times.wall[kPublishing] = times.processor[kPublishing] = 5e-5;
  return times;
}

LateSteps afterUsualSteps()
{
  LateSteps late(kSlot);
  for (int k = 0; k < 1000; ++k)
    late.add(usualStep(), 0.0, false, false);
  return late;
}

TEST(LateSteps, AreCountedAtThePhaseThatTookLong)
{
  for (const std::size_t phase : {kSimulation, kTransport, kPublishing})
  {
    LateSteps late = afterUsualSteps();
    LoopTimes times = usualStep();
    times.wall[phase] += 5e-3;
    times.processor[phase] += phase == kTransport ? 0.0 : 5e-3;
    late.add(times, 0.0, true, true);
    EXPECT_EQ(late.count(phase), 1U) << LateSteps::nameOf(phase);
  }
}

TEST(LateSteps, OfABacklogHaveTheCauseOfTheStepThatLeftIt)
{
  LateSteps late = afterUsualSteps();
  LoopTimes times = usualStep();
  times.wall[kPublishing] += 5e-3;
  times.processor[kPublishing] += 5e-3;
  late.add(times, 0.0, true, true);
  for (int k = 0; k < 7; ++k)
    late.add(usualStep(), 0.0, true, true);
  EXPECT_EQ(late.count(kPublishing), 8U);
  late.add(usualStep(), 0.0, false, false);
  times = usualStep();
  times.wall[kSimulation] += 3e-3;
  times.processor[kSimulation] += 3e-3;
  late.add(times, 0.0, true, true);
  EXPECT_EQ(late.count(kSimulation), 1U);
}

TEST(LateSteps, OfAThreadThatDidNotRunAreNotThoseOfItsPhase)
{
  LateSteps late = afterUsualSteps();
  LoopTimes times = usualStep();
  times.wall[kSimulation] += 5e-3;  // without processor time
  late.add(times, 0.0, true, true);
  EXPECT_EQ(late.count(kSimulation), 0U);
  EXPECT_EQ(late.count(LateSteps::kNotRun), 1U);
}

TEST(LateSteps, OfALoopThatWokeTooLateAreCountedAsThat)
{
  LateSteps late = afterUsualSteps();
  late.add(usualStep(), 4e-3, true, true);
  EXPECT_EQ(late.count(LateSteps::kWoken), 1U);
}

TEST(LateSteps, OfALoopThatIsAlwaysTooSlowAreThoseOfItsLongestPhase)
{
  LateSteps late(kSlot);
  LoopTimes times = usualStep();
  times.wall[kSimulation] = times.processor[kSimulation] = 1.2e-3;
  for (int k = 0; k < 1000; ++k)
    late.add(times, 0.0, true, true);
  EXPECT_EQ(late.count(kSimulation), 1000U);
}

}  // namespace
}  // namespace endovascular_sim::nodes
