#include "nodes/fluoroscopy/pulse_states.h"

#include <gtest/gtest.h>

#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::nodes
{
namespace
{

using fluoroscopy::motionAt;
using fluoroscopy::PulseTrain;

// Pulses 1, 2, 3, ... are after 67, 134, 200, 267, 334, 400 steps.
const PulseTrain kPulses(15.0, 1e-3);

/** Instruments and balloons that are known by the number of their nodes, or their own. @{ */
simulation::ImagedInstruments wires(std::size_t count)
{
  return {std::vector<Eigen::Vector3d>(count), {0.0}};
}

simulation::ImagedTreatment balloons(std::size_t count)
{
  simulation::ImagedTreatment treatment;
  treatment.balloons.resize(count);
  return treatment;
}
/** @} */

TEST(PulseStates, GivesTheNewestStateAtAPulse)
{
  PulseStates states(kPulses, {}, false);
  EXPECT_FALSE(states.take(false));
  std::size_t count = 0;
  for (const std::uint64_t steps : {64, 67, 80, 134, 144, 160})
    if (states.accepts(steps))
      states.addInstruments(steps, wires(++count));
  const std::optional<ImagedState> state = states.take(false);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->steps, 134U);
  EXPECT_EQ(state->pulse, 2U);
  EXPECT_EQ(state->instruments.nodes.size(), 3U);  // 80, 144 and 160 were not accepted
  EXPECT_FALSE(states.take(false));
}

TEST(PulseStates, GivesEveryPulseInOrderOnRequest)
{
  PulseStates states(kPulses, {}, false);
  for (std::uint64_t pulse = 1; pulse < 9; ++pulse)
    states.addInstruments(kPulses.stepOf(pulse), {});
  for (std::uint64_t pulse = 1; pulse < 4; ++pulse)
    EXPECT_EQ(states.take(true)->pulse, pulse);
  EXPECT_EQ(states.take(false)->pulse, 8U);
  EXPECT_FALSE(states.take(true));
}

TEST(PulseStates, WaitsForAllPartsOfAStateInAnyOrder)
{
  PulseStates states(kPulses, {true, true}, false);
  states.addInstruments(67, wires(1));
  states.addMotion(67, motionAt(0.1, 0.0));
  states.addTreatment(67, {});
  EXPECT_EQ(states.take(false)->pulse, 1U);
  states.addMotion(134, motionAt(0.2, 0.0));
  states.addTreatment(134, balloons(3));
  EXPECT_FALSE(states.take(false));
  states.addInstruments(134, wires(2));
  states.addInstruments(200, wires(5));
  const std::optional<ImagedState> state = states.take(false);  // the state of pulse 3 is not complete
  ASSERT_TRUE(state);
  EXPECT_EQ(state->pulse, 2U);
  EXPECT_EQ(state->treatment->balloons.size(), 3U);
  EXPECT_EQ(*state->motion, motionAt(0.2, 0.0));
  states.addTreatment(200, {});
  EXPECT_FALSE(states.take(false));
  states.addMotion(200, motionAt(0.3, 0.0));
  EXPECT_EQ(*states.take(false)->motion, motionAt(0.3, 0.0));
}

TEST(PulseStates, WaitsForTheContrastMediumOfAState)
{
  PulseStates states(kPulses, {false, false, true}, false);
  states.addContrast(67, {{1.0}, {}});
  states.addInstruments(67, wires(1));
  EXPECT_EQ(states.take(false)->contrast->cells, std::vector<double>{1.0});
  states.addInstruments(134, wires(1));
  EXPECT_FALSE(states.take(false));
  states.addContrast(134, {{2.0}, {350.0}});
  const std::optional<ImagedState> state = states.take(false);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->contrast->cells, std::vector<double>{2.0});
  EXPECT_EQ(state->contrast->instruments, std::vector<double>{350.0});
}

TEST(PulseStates, OfARecordingHaveTheLastContrastMediumThatIsKnown)
{
  PulseStates states(kPulses, {false, false, true}, true);
  states.addContrast(80, {{3.0}, {}});
  states.addInstruments(80, wires(1));
  states.take(false);
  states.addInstruments(150, wires(1));
  EXPECT_EQ(states.take(false)->contrast->cells, std::vector<double>{3.0});
}

TEST(PulseStates, TakesAnyStateBeforeTheFirstPulse)
{
  PulseStates states(kPulses, {true, false}, false);
  states.addInstruments(16, wires(1));
  EXPECT_EQ(states.take(false)->steps, 16U);
  states.addInstruments(32, wires(1));
  EXPECT_FALSE(states.take(false));  // of the same pulse
}

TEST(PulseStates, OfARecordingTakesTheFirstStateAfterAPulse)
{
  PulseStates states(kPulses, {true, false}, true);
  states.addMotion(80, motionAt(0.1, 0.0));
  states.addInstruments(80, wires(1));
  EXPECT_EQ(states.take(false)->steps, 80U);
  states.addInstruments(112, wires(1));
  EXPECT_FALSE(states.take(false));
  states.addInstruments(200, wires(1));  // at a pulse, by chance
  EXPECT_EQ(states.take(false)->pulse, 3U);
  EXPECT_TRUE(states.accepts(272));
  states.addInstruments(272, wires(1));
  const std::optional<ImagedState> state = states.take(false);
  EXPECT_EQ(state->steps, 272U);
  EXPECT_EQ(*state->motion, motionAt(0.1, 0.0));  // the last one that is known
}

TEST(PulseStates, BeginsAnewAfterAStepBack)
{
  PulseStates states(kPulses, {}, false);
  states.addInstruments(400, wires(1));
  EXPECT_EQ(states.take(false)->pulse, 6U);
  states.addInstruments(467, wires(1));
  states.addInstruments(16, wires(1));
  EXPECT_EQ(states.take(false)->steps, 16U);
  states.addInstruments(67, wires(1));
  EXPECT_EQ(states.take(false)->pulse, 1U);
  EXPECT_FALSE(states.take(false));
}

TEST(PulseStates, ForgetsTheOldestOfManyThatWait)
{
  PulseStates states(kPulses, {}, false);
  for (std::uint64_t pulse = 1; pulse <= 2 * PulseStates::kMost; ++pulse)
    states.addInstruments(kPulses.stepOf(pulse), {});
  EXPECT_EQ(states.take(true)->pulse, PulseStates::kMost + 1);
}

}  // namespace
}  // namespace endovascular_sim::nodes
