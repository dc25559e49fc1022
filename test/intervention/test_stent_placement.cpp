#include "intervention/stent_placement.h"

#include <gtest/gtest.h>

#include "geometry/polyline.h"
#include "test/intervention/treated_tube.h"

namespace endovascular_sim::intervention
{
namespace
{

double middleOf(const RoundBody& sleeve)
{
  return 0.5 * (sleeve.axis.front().z() + sleeve.axis.back().z());
}

TEST(StentPlacement, StaysCrimpedOnItsBalloonBelowItsOpeningPressure)
{
  StentPlacement placement(stent(), balloon());
  EXPECT_EQ(placement.update(shaftAt(0.03), 2.5 * kAtmosphere, 2.45e-3), StentPlacement::State::kCrimped);
  EXPECT_NEAR(placement.outerDiameter(), 1.1e-3, 1e-12);
  EXPECT_NEAR(middleOf(placement.sleeve()), 0.03, 1e-9);
  placement.update(shaftAt(0.035), 0.0, 0.9e-3);
  EXPECT_NEAR(middleOf(placement.sleeve()), 0.035, 1e-9) << "moves with the balloon";
}

TEST(StentPlacement, ExpandsShortensRecoilsAndIsPlaced)
{
  StentPlacement placement(stent(), balloon());
  placement.update(shaftAt(0.03), 8.0 * kAtmosphere, 3.0e-3);
  EXPECT_EQ(placement.state(), StentPlacement::State::kExpanding);
  EXPECT_NEAR(placement.innerDiameter(), 3.0e-3, 1e-12);
  EXPECT_NEAR(placement.length(), 14.0e-3, 1e-12);
  EXPECT_NEAR(geometry::Polyline(placement.sleeve().axis).length(), 14.0e-3, 1e-9);
  placement.update(shaftAt(0.03), 4.0 * kAtmosphere, 2.9e-3);
  EXPECT_EQ(placement.state(), StentPlacement::State::kExpanding) << "the balloon still fills the stent";
  EXPECT_EQ(placement.update(shaftAt(0.03), 1.0 * kAtmosphere, 1.6e-3), StentPlacement::State::kPlaced);
  EXPECT_NEAR(placement.innerDiameter(), 0.95 * 3.0e-3, 1e-12);
  EXPECT_NEAR(placement.outerDiameter(), 0.95 * 3.0e-3 + 0.18e-3, 1e-12);
  placement.update(shaftAt(0.01), 8.0 * kAtmosphere, 3.2e-3);
  EXPECT_NEAR(middleOf(placement.sleeve()), 0.03, 1e-9) << "fixed in space";
  EXPECT_NEAR(placement.innerDiameter(), 0.95 * 3.0e-3, 1e-12);
}

TEST(StentPlacement, DoesNotExpandBeyondItsLargestDiameter)
{
  StentPlacement placement(stent(), balloon());
  placement.update(shaftAt(0.03), 16.0 * kAtmosphere, 3.6e-3);
  EXPECT_TRUE(placement.overExpanded());
  EXPECT_NEAR(placement.innerDiameter(), 3.5e-3, 1e-12);
}

TEST(StentPlacement, IsLostIfDislodgedBeforeExpansion)
{
  StentPlacement placement(stent(), balloon());
  placement.update(shaftAt(0.03), 0.0, 0.9e-3);
  placement.dislodge();
  EXPECT_EQ(placement.update(shaftAt(0.01), 8.0 * kAtmosphere, 3.0e-3), StentPlacement::State::kLost);
  EXPECT_NEAR(middleOf(placement.sleeve()), 0.03, 1e-9);
  StentPlacement opened(stent(), balloon());
  opened.update(shaftAt(0.03), 8.0 * kAtmosphere, 3.0e-3);
  opened.dislodge();
  EXPECT_EQ(opened.state(), StentPlacement::State::kExpanding);
}

TEST(StentPlacement, HasStrutsOnItsSurfaceOverItsLength)
{
  StentPlacement placement(stent(), balloon());
  EXPECT_TRUE(placement.struts().empty());
  placement.update(shaftAt(0.03), 8.0 * kAtmosphere, 3.0e-3);
  const auto rings = placement.struts();
  EXPECT_EQ(rings.size(), 9U);
  double low = 1.0;
  double high = 0.0;
  for (const auto& ring : rings)
    for (const Eigen::Vector3d& p : ring)
    {
      EXPECT_NEAR(p.head<2>().norm(), 0.5 * placement.outerDiameter(), 1e-9);
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
  EXPECT_NEAR(high - low, 14.0e-3 * (1.0 - 0.2 / 9.0), 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::intervention
