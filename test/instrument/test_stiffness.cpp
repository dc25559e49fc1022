#include "instrument/stiffness.h"

#include <gtest/gtest.h>

#include <cmath>

namespace endovascular_sim::instrument
{
namespace
{

TEST(Stiffness, EqualsModulusTimesSectionIntegralForASolidSection)
{
  // Integrals of y² and r² over the disc by the midpoint rule in polar coordinates
  const double radius = 0.3;
  double second_moment = 0.0;
  double polar_moment = 0.0;
  double area = 0.0;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
    {
      const double r = (i + 0.5) * radius / n;
      const double angle = (j + 0.5) * 2.0 * M_PI / n;
      const double cell = r * (radius / n) * (2.0 * M_PI / n);
      area += cell;
      polar_moment += r * r * cell;
      second_moment += std::pow(r * std::sin(angle), 2) * cell;
    }
  const Stiffness stiffness = solidSection(7.0, 5.0, radius);
  EXPECT_NEAR(stiffness.bending, 7.0 * second_moment, 1e-5 * stiffness.bending);
  EXPECT_NEAR(stiffness.torsional, 5.0 * polar_moment, 1e-5 * stiffness.torsional);
  EXPECT_NEAR(stiffness.axial, 7.0 * area, 1e-5 * stiffness.axial);
}

TEST(Stiffness, HasTheRatioOnePlusPoissonOfBendingToTorsion)
{
  const Stiffness stiffness = solidSection(80e9, shearModulus(80e9, 0.3), 4e-4);
  EXPECT_NEAR(stiffness.bending / stiffness.torsional, 1.3, 1e-12);
}

TEST(Stiffness, IsRecoveredFromTheEquivalentModulus)
{
  EXPECT_NEAR(equivalentYoungModulus(solidSection(123e9, 1.0, 2e-4).bending, 2e-4), 123e9, 1.0);
}

TEST(Stiffness, OfATubeIsOuterCylinderMinusLumen)
{
  const double e = 1e9;
  const double g = 0.4e9;
  const Stiffness tube = hollowSection(e, g, 1e-3, 0.7e-3);
  EXPECT_NEAR(tube.bending, e * M_PI * (1e-12 - 0.2401e-12) / 4.0, 1e-15);
  EXPECT_NEAR(tube.torsional, g * M_PI * (1e-12 - 0.2401e-12) / 2.0, 1e-15);
  EXPECT_NEAR(tube.axial, e * M_PI * (1e-6 - 0.49e-6), 1e-9);
  EXPECT_NEAR(equivalentYoungModulus(tube.bending, 1e-3, 0.7e-3), e, 1e-3);
  EXPECT_EQ(hollowSection(e, g, 1e-3, 0.0).bending, solidSection(e, g, 1e-3).bending);
}

}  // namespace
}  // namespace endovascular_sim::instrument
