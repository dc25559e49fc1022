#include "nodes/fluoroscopy/frame_counter.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(FrameCounter, CountsThePulsesThatAreLeftOut)
{
  FrameCounter counter;
  for (const std::uint64_t pulse : {10, 11, 12, 15, 16, 19})
    counter.draw(pulse);
  EXPECT_EQ(counter.drawn(), 6U);
  EXPECT_EQ(counter.leftOut(), 4U);  // 13 and 14, 17 and 18
}

TEST(FrameCounter, CountsAPulseThatIsDrawnAgainOnce)
{
  FrameCounter counter;
  for (const std::uint64_t pulse : {1, 1, 1, 2})
    counter.draw(pulse);
  EXPECT_EQ(counter.drawn(), 2U);
  EXPECT_EQ(counter.leftOut(), 0U);
}

TEST(FrameCounter, CountsNoPulsesWhileNobodySeesThemAndAfterAStepBack)
{
  FrameCounter counter;
  counter.draw(10);
  counter.pause();
  counter.draw(600);
  counter.draw(601);
  counter.draw(5);
  counter.draw(6);
  EXPECT_EQ(counter.leftOut(), 0U);
  EXPECT_EQ(counter.drawn(), 5U);
}

}  // namespace
}  // namespace endovascular_sim::nodes
