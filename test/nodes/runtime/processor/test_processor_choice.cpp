#include "nodes/runtime/processor/processor_choice.h"

#include <numeric>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

std::vector<int> firstProcessors(int count)
{
  std::vector<int> processors(static_cast<std::size_t>(count));
  std::iota(processors.begin(), processors.end(), 0);
  return processors;
}

TEST(ProcessorChoice, SpreadsSessionsOverAllProcessorsBeforeItSharesOne)
{
  for (int count = 2; count <= 64; ++count)
  {
    std::vector<int> held;
    for (int session = 0; session < 2 * count; ++session)
    {
      const ProcessorChoice choice = chooseProcessor(firstProcessors(count), held);
      ASSERT_EQ(choice.processor, count - 1 - session % count) << count << " processors, session " << session;
      ASSERT_EQ(choice.other_sessions, static_cast<std::size_t>(session / count));
      held.push_back(choice.processor);
    }
  }
}

TEST(ProcessorChoice, UsesAllowedProcessorsOnly)
{
  EXPECT_EQ(chooseProcessor({2, 5}, {}).processor, 5);
  EXPECT_EQ(chooseProcessor({2, 5}, {5}).processor, 2);
  EXPECT_EQ(chooseProcessor({2, 5}, {0, 1, 3, 4}).processor, 5);
  EXPECT_EQ(chooseProcessor({3}, {3, 3}).other_sessions, 2U);
  EXPECT_EQ(chooseProcessor({}, {}).processor, -1);
}

TEST(ProcessorChoice, LeavesTheCoreOfTheLoopToItWhereTwoOtherProcessorsAreLeft)
{
  using Processors = std::vector<int>;
  EXPECT_EQ(processorsBesideLoop(firstProcessors(1), 0, {0}), (Processors{0}));
  EXPECT_EQ(processorsBesideLoop(firstProcessors(2), 1, {1}), (Processors{0}));
  EXPECT_EQ(processorsBesideLoop(firstProcessors(2), 1, {0, 1}), (Processors{0}));
  EXPECT_EQ(processorsBesideLoop(firstProcessors(4), 3, {3}), (Processors{0, 1, 2}));
  EXPECT_EQ(processorsBesideLoop(firstProcessors(4), 3, {1, 3}), (Processors{0, 2}));
  EXPECT_EQ(processorsBesideLoop({1, 2, 3}, 3, {2, 3}), (Processors{1, 2}));
  EXPECT_EQ(processorsBesideLoop(firstProcessors(4), -1, {}), firstProcessors(4));
}

TEST(ProcessorChoice, ReadsTheProcessorsOfACore)
{
  using Processors = std::vector<int>;
  EXPECT_EQ(processorsOfList("3\n"), (Processors{3}));
  EXPECT_EQ(processorsOfList("1,5"), (Processors{1, 5}));
  EXPECT_EQ(processorsOfList("0-2,9"), (Processors{0, 1, 2, 9}));
  EXPECT_EQ(processorsOfList(""), Processors());
  EXPECT_EQ(processorsOfList("1-999999999"), Processors());
  EXPECT_EQ(processorsOfList("x"), Processors());
}

}  // namespace
}  // namespace endovascular_sim::nodes
