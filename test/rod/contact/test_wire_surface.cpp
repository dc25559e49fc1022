#include "rod/contact/wire_surface.h"

#include <vector>

#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kRadius = 0.2e-3;

class WireSurfaceOfFiveNodes : public testing::Test
{
protected:
  const Discretisation rod_ = discretiseUniformly(uniformWire(0.04, 5e-5, kRadius, 7900.0), 5);
  WireSurface surface_{rod_};
};

TEST_F(WireSurfaceOfFiveNodes, IsTheWireWithoutABalloon)
{
  EXPECT_EQ(surface_.radius(3), kRadius);
  EXPECT_FALSE(surface_.hasWideBalloon());
  EXPECT_FALSE(surface_.isWideAround(2));
}

TEST_F(WireSurfaceOfFiveNodes, HasTheLargerRadiusOfWireAndBalloon)
{
  surface_.setLeastRadius({0.0, 0.1e-3, 1.5e-3, 0.0, 0.0});
  EXPECT_EQ(surface_.radius(1), kRadius);
  EXPECT_EQ(surface_.radius(2), 1.5e-3);
  EXPECT_NEAR(surface_.growthTo(1.6e-3, 2), 0.1e-3, 1e-15);
  EXPECT_NEAR(surface_.growthTo(0.0, 2), kRadius - 1.5e-3, 1e-15);
  EXPECT_TRUE(surface_.hasWideBalloon());
  EXPECT_TRUE(surface_.isWideAround(1));
  EXPECT_TRUE(surface_.isWideAround(3));
  EXPECT_FALSE(surface_.isWideAround(4));
}

TEST_F(WireSurfaceOfFiveNodes, MeasuresTheGapToAFeaturesPlaneAtItsParameter)
{
  surface_.setLeastRadius({0.0, 0.0, 1e-3, 0.0, 0.0});
  State state;
  state.position.assign(5, Eigen::Vector3d::Zero());
  state.position[1].z() = 2e-3;
  state.position[2].z() = 4e-3;
  contact::Feature feature;
  feature.edge = 1;
  feature.parameter = 0.25;
  feature.normal = Eigen::Vector3d::UnitZ();
  feature.point = Eigen::Vector3d(1.0, 2.0, 0.5e-3);
  EXPECT_NEAR(surface_.gapTo(feature, state), 2.5e-3 - 0.5e-3 - (0.75 * kRadius + 0.25e-3), 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::rod
