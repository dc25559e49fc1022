#include <gtest/gtest.h>

#include "rod/coaxial/layer_profile.h"
#include "test/rod/stack_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

/** Wire of 200 mm: shaft, soft straight part and curved tip. */
Wire threePartWire()
{
  Wire wire = curvedTipWire(0.2, 0.02, 3e-5, 0.5e-3, 80.0);
  Section soft = uniformWire(0.0307, 1e-5, 0.4e-3, 4000.0).sections[0];
  wire.sections[0].length -= soft.length;
  wire.sections.insert(wire.sections.begin() + 1, soft);
  wire.sections[2].rest_curvature = Eigen::Vector2d(20.0, 80.0);
  wire.sections[1].friction = 0.05;
  return wire;
}

/** Uneven nodes over 200 mm. */
std::vector<double> unevenNodes()
{
  std::vector<double> position = {0.0};
  for (int k = 0; position.back() < 0.199; ++k)
    position.push_back(std::min(0.2, position.back() + (k % 3 == 0 ? 1e-3 : 2e-3)));
  return position;
}

TEST(LayerProfile, DerivativesByTheInsertionAgreeWithFiniteDifferences)
{
  LayerProfile profile(threePartWire(), unevenNodes());
  LayerProfile moved = profile;
  std::vector<int> changed;
  const double step = 1e-8;
  for (const double tip : {0.1003, 0.1217, 0.1995})
  {
    profile.slideTo(tip, changed);
    ASSERT_FALSE(profile.slidingNodes().empty());
    for (const int i : profile.slidingNodes())
    {
      const LayerProfile::Slope slope = profile.slope(i);
      const auto difference = [&](auto value)
      {
        moved.slideTo(tip + step, changed);
        const auto after = value(moved);
        moved.slideTo(tip - step, changed);
        const auto before = value(moved);
        return ((after - before) / (2.0 * step));
      };
      const auto expect = [&](double expected, double actual, double scale)
      { EXPECT_NEAR(expected, actual, 1e-5 * scale) << "tip " << tip << ", node " << i; };
      expect(difference([i](const LayerProfile& p) { return p.rod().mass[i]; }), slope.mass, 6e-3);
      expect(difference([i](const LayerProfile& p) { return p.rod().radius[i]; }), slope.radius, 0.5);
      expect(difference([i](const LayerProfile& p) { return p.cover(i); }), slope.cover, 1e3);
    }
  }
}

TEST(LayerProfile, PropertiesDoNotDependOnEarlierPositions)
{
  LayerProfile travelled(threePartWire(), unevenNodes());
  LayerProfile fresh(threePartWire(), unevenNodes());
  std::vector<int> changed;
  for (const double tip : {0.05, 0.0523, 0.19, 0.1201, 0.12345})
    travelled.slideTo(tip, changed);
  fresh.slideTo(0.12345, changed);
  EXPECT_EQ(travelled.rod().bending_stiffness, fresh.rod().bending_stiffness);
  EXPECT_EQ(travelled.rod().mass, fresh.rod().mass);
  EXPECT_EQ(travelled.rod().radius, fresh.rod().radius);
  EXPECT_EQ(travelled.rod().position, fresh.rod().position);
  EXPECT_EQ(travelled.rod().first_curved, fresh.rod().first_curved);
  EXPECT_EQ(travelled.slidingNodes(), fresh.slidingNodes());
  for (std::size_t i = 0; i < fresh.rod().rest_curvature.size(); ++i)
    EXPECT_EQ(travelled.rod().rest_curvature[i], fresh.rod().rest_curvature[i]);
}

TEST(LayerProfile, ALayerKeepsItsMassAndItsRestAngleWhereverItsTipIs)
{
  LayerProfile profile(threePartWire(), unevenNodes());
  std::vector<int> changed;
  for (const double tip : {0.1, 0.10077, 0.15, 0.1999})
  {
    profile.slideTo(tip, changed);
    double curved = 0.0;
    double mass = 0.0;
    for (std::size_t i = 0; i < profile.rod().mass.size(); ++i)
    {
      mass += profile.rod().mass[i];
      // The rest angle of the covered part: 2 atan(κ̄b/2) times the cover.
      curved += profile.cover(static_cast<int>(i)) * 2.0 * std::atan(0.5 * profile.rod().rest_curvature[i].norm());
    }
    // The first section is extended beyond the wire's proximal end.
    const double whole = massBetween(threePartWire(), 0.0, 0.2) + (tip - 0.2) * 6000.0 * M_PI * 0.25e-6;
    EXPECT_NEAR(mass, whole, 1e-9 * whole);
    EXPECT_NEAR(curved, 0.02 * Eigen::Vector2d(20.0, 80.0).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
