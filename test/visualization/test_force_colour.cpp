#include "visualization/force_colour.h"

#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::visualization
{
namespace
{

TEST(ForceColour, ChangesFromGreyToRedAndSaturates)
{
  EXPECT_FLOAT_EQ(forceColour(0.0, 0.1).red, 0.75F);
  EXPECT_FLOAT_EQ(forceColour(0.1, 0.1).red, 0.85F);
  EXPECT_FLOAT_EQ(forceColour(0.1, 0.1).green, 0.05F);
  EXPECT_FLOAT_EQ(forceColour(7.0, 0.1).blue, forceColour(0.1, 0.1).blue);
  EXPECT_GT(forceColour(0.03, 0.1).green, forceColour(0.08, 0.1).green);
  EXPECT_FLOAT_EQ(forceColour(std::numeric_limits<double>::quiet_NaN(), 0.1).red, 0.75F);
}

}  // namespace
}  // namespace endovascular_sim::visualization
