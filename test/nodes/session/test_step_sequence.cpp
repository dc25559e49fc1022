#include "nodes/session/step_sequence.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

SessionSteps group(std::uint64_t first, std::size_t size)
{
  SessionSteps steps;
  for (std::size_t k = 0; k < size; ++k)
  {
    steps.steps.emplace_back();
    steps.steps.back().step = first + k;
  }
  return steps;
}

TEST(StepSequence, AcceptsGroupsThatFollowEachOther)
{
  StepSequence sequence(1e-3);
  sequence.accept(group(0, 5), "/rod");
  sequence.setHandled(5);
  sequence.accept(group(5, 5), "/rod");
  EXPECT_THROW(sequence.accept(group(5, 5), "/stranger"), std::runtime_error);
}

TEST(StepSequence, ContinuesWithTheSecondGroupAfterAGap)
{
  StepSequence sequence(1e-3);
  sequence.accept(group(0, 5), "/rod");
  sequence.setHandled(5);
  EXPECT_THROW(sequence.accept(group(20, 5), "/rod"), InputError);
  sequence.accept(group(25, 5), "/rod");
}

TEST(StepSequence, RefusesMessagesFarAheadOrOfAnotherTime)
{
  StepSequence sequence(1e-3);
  RodStateVisual rod;
  rod.step = 9;
  rod.time = 0.01;
  sequence.requireKnown(rod, "rod/state_visual");
  rod.time = 0.02;
  EXPECT_THROW(sequence.requireKnown(rod, "rod/state_visual"), InputError);
  rod.step = kStepQueue + 1;
  rod.time = 1e-3 * (kStepQueue + 2);
  EXPECT_THROW(sequence.requireKnown(rod, "rod/state_visual"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::nodes
