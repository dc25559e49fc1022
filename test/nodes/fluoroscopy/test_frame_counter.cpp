#include "nodes/fluoroscopy/frame_counter.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(FrameCounter, CountsTheFramesThatAreLeftOut)
{
  FrameCounter counter(0.1);
  for (const double time : {10.0, 10.1, 10.2, 10.51, 10.6, 10.86})
    counter.draw(time);
  EXPECT_EQ(counter.drawn(), 6U);
  EXPECT_EQ(counter.leftOut(), 4U);  // two before the one at 10.51, two before that at 10.86
}

TEST(FrameCounter, CountsNoFramesWhileNobodySeesThem)
{
  FrameCounter counter(0.1);
  counter.draw(10.0);
  counter.pause();
  counter.draw(60.0);
  counter.draw(60.1);
  EXPECT_EQ(counter.leftOut(), 0U);
  EXPECT_EQ(counter.drawn(), 3U);
}

}  // namespace
}  // namespace endovascular_sim::nodes
