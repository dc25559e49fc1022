#include "visualization/colour_legend.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::visualization
{
namespace
{

TEST(RoundFullScale, IsTheSmallestRoundNumberThatIsNotBelowTheValue)
{
  EXPECT_DOUBLE_EQ(roundFullScale(0.3, 0.01), 0.5);
  EXPECT_DOUBLE_EQ(roundFullScale(0.5, 0.01), 0.5);
  EXPECT_DOUBLE_EQ(roundFullScale(0.51, 0.01), 1.0);
  EXPECT_DOUBLE_EQ(roundFullScale(0.1, 0.01), 0.1);
  EXPECT_DOUBLE_EQ(roundFullScale(17.0, 0.01), 20.0);
}

TEST(RoundFullScale, IsTheSmallestScaleForSmallAndInvalidValues)
{
  for (const double value : {0.0, -1.0, 0.005, std::numeric_limits<double>::quiet_NaN(), HUGE_VAL})
    EXPECT_DOUBLE_EQ(roundFullScale(value, 0.01), 0.01);
}

TEST(LegendScale, HasRoundLabelsInAReadableUnit)
{
  const LegendScale half = legendScale(0.5, "N");
  EXPECT_EQ(half.unit, "mN");
  EXPECT_EQ(half.labels, (std::vector<std::string>{"0", "100", "200", "300", "400", "500"}));
  const LegendScale two = legendScale(2.0, "N");
  EXPECT_EQ(two.unit, "N");
  EXPECT_EQ(two.labels, (std::vector<std::string>{"0", "0.5", "1", "1.5", "2"}));
  EXPECT_DOUBLE_EQ(two.ticks.back(), 2.0);
}

TEST(FollowingScale, GrowsWithTheSceneAndDoesNotShrinkBeforeAReset)
{
  FollowingScale scale(0.05);
  EXPECT_FALSE(scale.follow(0.01));
  EXPECT_TRUE(scale.follow(0.3));
  EXPECT_DOUBLE_EQ(scale.full(), 0.5);
  EXPECT_FALSE(scale.follow(0.1));
  EXPECT_FALSE(scale.follow(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_DOUBLE_EQ(scale.full(), 0.5);
  scale.reset();
  EXPECT_DOUBLE_EQ(scale.full(), 0.05);
}

}  // namespace
}  // namespace endovascular_sim::visualization
