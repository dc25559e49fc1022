#include "rod/contact/wall_compliance.h"

#include <vector>

#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kRadius = 0.3e-3;
constexpr double kReach = 0.25e-3;

contact::Feature featureOf(double gap, bool soft)
{
  contact::Feature feature;
  feature.edge = 1;
  feature.gap = gap;
  feature.id = 6;
  if (soft)
    feature.stiffness = 1e5;
  return feature;
}

class StiffLayers : public testing::Test
{
protected:
  std::vector<contact::Feature> layered(double gap, bool soft) const
  {
    std::vector<contact::Feature> features = {featureOf(gap, soft)};
    addStiffLayer(
        rod_, [](int) { return kReach; }, features);
    return features;
  }

  const Discretisation rod_ = discretiseUniformly(uniformWire(0.04, 5e-5, kRadius, 7900.0), 5);
};

TEST(SoftWallTravel, LeavesTheAxisInTheLumen)
{
  EXPECT_EQ(softWallTravel(0.1e-3), 0.05e-3);
  EXPECT_NEAR(softWallTravel(0.5e-3), 0.4e-3, 1e-15);
  for (const double radius : {0.04e-3, 0.2e-3, 1e-3})
    EXPECT_LT(softWallTravel(radius), radius);
}

TEST_F(StiffLayers, StandFortyMicrometresBehindARigidWallThatIsPressedInByHalfOfThat)
{
  EXPECT_EQ(layered(-19e-6, false).size(), 1U);
  const std::vector<contact::Feature> features = layered(-21e-6, false);
  ASSERT_EQ(features.size(), 2U);
  EXPECT_NEAR(features[1].gap, 19e-6, 1e-15);
  EXPECT_TRUE(isStiffLayer(features[1]));
  EXPECT_FALSE(isStiffLayer(features[0]));
}

TEST_F(StiffLayers, StandBehindTheTravelOfASoftWallWithinTheReach)
{
  const double travel = softWallTravel(kRadius);
  EXPECT_EQ(layered(kReach - travel + 1e-6, true).size(), 1U);
  const std::vector<contact::Feature> features = layered(kReach - travel - 1e-6, true);
  ASSERT_EQ(features.size(), 2U);
  EXPECT_NEAR(features[1].gap, kReach - 1e-6, 1e-15);
}

TEST_F(StiffLayers, AreRemovedWithoutAChangeOfTheWallsFeatures)
{
  std::vector<contact::Feature> features = layered(-50e-6, false);
  ASSERT_EQ(features.size(), 2U);
  removeStiffLayer(features);
  ASSERT_EQ(features.size(), 1U);
  EXPECT_EQ(features[0].gap, -50e-6);
  EXPECT_EQ(features[0].id, 6);
}

TEST_F(StiffLayers, UseTheWiresRadiusAtTheContactOnATaper)
{
  Discretisation tapered = rod_;
  tapered.radius[2] = 0.1e-3;
  contact::Feature feature = featureOf(0.0, true);
  feature.parameter = 0.25;
  EXPECT_NEAR(wireRadiusAt(feature, tapered), 0.25e-3, 1e-15);
  EXPECT_NEAR(stiffLayerDepth(feature, tapered), 0.15e-3, 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::rod
