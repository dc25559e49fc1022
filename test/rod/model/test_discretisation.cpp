#include "rod/model/discretisation.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace endovascular_sim::rod
{
namespace
{

Wire twoSections()
{
  Section shaft;
  shaft.length = 0.3;
  shaft.bending_stiffness = 4e-3;
  shaft.torsional_stiffness = 3e-3;
  shaft.axial_stiffness = 1e4;
  shaft.radius = 4e-4;
  shaft.density = 7000.0;
  Section tip = shaft;
  tip.length = 0.02;
  tip.bending_stiffness = 1e-4;
  tip.torsional_stiffness = 8e-5;
  tip.radius = 3e-4;
  tip.rest_curvature = Eigen::Vector2d(0.0, -100.0);
  Wire wire;
  wire.sections = {shaft, tip};
  return wire;
}

TEST(Discretisation, KeepsMassComplianceAndRestAngleOfTheWireForAnyNumberOfNodes)
{
  const Wire wire = twoSections();
  const double mass = M_PI * 7000.0 * (0.3 * 4e-4 * 4e-4 + 0.02 * 3e-4 * 3e-4);
  for (int nodes : {3, 17, 240})
  {
    const Discretisation rod = discretiseUniformly(wire, nodes);
    double bending = 0.0;
    double torsion = 0.0;
    double angle = 0.0;
    for (int i = 0; i < nodes; ++i)
    {
      bending += rod.cell_length[i] / rod.bending_stiffness[i];
      torsion += rod.cell_length[i] / rod.torsional_stiffness[i];
      angle += 2.0 * std::atan(0.5 * rod.rest_curvature[i].y());
    }
    EXPECT_NEAR(std::accumulate(rod.mass.begin(), rod.mass.end(), 0.0), mass, 1e-12 * mass);
    EXPECT_NEAR(bending, 0.3 / 4e-3 + 0.02 / 1e-4, 1e-9);
    EXPECT_NEAR(torsion, 0.3 / 3e-3 + 0.02 / 8e-5, 1e-9);
    EXPECT_NEAR(angle, -2.0, 1e-12);
  }
}

TEST(Discretisation, FindsTheFirstNodeWithRestCurvature)
{
  const Discretisation rod = discretiseUniformly(twoSections(), 161);  // edges of 2 mm
  EXPECT_EQ(rod.first_curved, 150);
  Wire straight = twoSections();
  straight.sections.pop_back();
  EXPECT_EQ(discretiseUniformly(straight, 50).first_curved, 50);
}

// EI κ̄²/2 · (κ̄ē)²/12 of the tip: 1e-4/2 · 100² · (100 · 2e-3)²/12 N = 1.67 mN.
TEST(Discretisation, DividesEdgesOfACurvedSectionUntilTheForceOfItsStraighteningIsWithinABound)
{
  const Wire wire = twoSections();
  EXPECT_EQ(resolvedPositions(wire, 161, 2e-3).size(), 161U);
  const std::vector<double> halved = resolvedPositions(wire, 161, 1e-3);
  ASSERT_EQ(halved.size(), 161U + 12U);  // two edges before the section are divided too
  EXPECT_NEAR(halved[148], 0.296, 1e-12);
  for (std::size_t i = 149; i < halved.size(); ++i)
    EXPECT_NEAR(halved[i] - halved[i - 1], 1e-3, 1e-12);
  EXPECT_EQ(halved.back(), wire.length());
  EXPECT_EQ(resolvedPositions(wire, 161, 0.1e-3).size(), 161U + 48U);
}

}  // namespace
}  // namespace endovascular_sim::rod
