#include "flow/drag/drag.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kDensity = 1060.0, kViscosity = 4e-3;

TEST(Drag, AcrossACylinderHasTheMeasuredCoefficients)
{
  // Drag coefficients of smooth cylinders, Wieselsberger 1921 as in White 2011, fig. 7.16a.
  for (const auto& [reynolds, coefficient] : {std::pair(10.0, 2.8), std::pair(100.0, 1.5), std::pair(1000.0, 1.1)})
  {
    const double diameter = 1e-3, speed = reynolds * kViscosity / (kDensity * diameter);
    const double force = crosswiseDrag(diameter, speed, kDensity, kViscosity) * speed;
    EXPECT_NEAR(force / (0.5 * kDensity * speed * speed * diameter), coefficient, 0.2 * coefficient) << reynolds;
  }
}

TEST(Drag, AcrossACylinderIsContinuousAndGrowsWithTheSpeed)
{
  double before = 0.0;
  for (double speed = 1e-7; speed < 2.0; speed *= 1.05)
  {
    const double force = crosswiseDrag(0.36e-3, speed, kDensity, kViscosity) * speed;
    EXPECT_GT(force, before);
    if (before > 0.0)
    {
      EXPECT_LT(force / before, 1.12) << speed;
    }
    before = force;
  }
  EXPECT_EQ(crosswiseDrag(1e-3, -0.3, kDensity, kViscosity), crosswiseDrag(1e-3, 0.3, kDensity, kViscosity));
}

TEST(Drag, OfAWireIsThatOfTheLiterature)
{
  // A wire of 0.014 inch in the peak flow of a coronary artery, 0.5 m/s: 77 mN/m across, 16 mN/m along (docs/FLOW.md).
  EXPECT_NEAR(crosswiseDrag(0.36e-3, 0.5, kDensity, kViscosity) * 0.5, 0.077, 0.008);
  EXPECT_NEAR(axialDrag(0.18e-3, 1.75e-3, kViscosity) * 0.5, 0.016, 0.004);
}

/** Axial drag by finite volumes: the annulus in rings, with no slip at both walls. */
double axialDragOfRings(double radius, double lumen, int rings)
{
  const double width = (lumen - radius) / rings;
  // µ (1/r) d/dr (r dv/dr) = −1 on rings; tridiagonal system by elimination.
  std::vector<double> diagonal(rings), upper(rings), right(rings), speed(rings);
  for (int k = 0; k < rings; ++k)
  {
    const double inner = radius + k * width, outer = inner + width;
    const double in = kViscosity * inner / (k == 0 ? 0.5 * width : width);
    const double out = kViscosity * outer / (k == rings - 1 ? 0.5 * width : width);
    diagonal[k] = in + out;
    upper[k] = k == rings - 1 ? 0.0 : -out;
    right[k] = 0.5 * (outer * outer - inner * inner);
    if (k > 0)
    {
      const double factor = in / diagonal[k - 1];
      diagonal[k] += factor * upper[k - 1];
      right[k] += factor * right[k - 1];
    }
  }
  double flow = 0.0;
  for (int k = rings - 1; k >= 0; --k)
  {
    speed[k] = (right[k] - (k == rings - 1 ? 0.0 : upper[k] * speed[k + 1])) / diagonal[k];
    const double inner = radius + k * width;
    flow += speed[k] * kPi * ((inner + width) * (inner + width) - inner * inner);
  }
  const double force = 2.0 * kPi * radius * kViscosity * speed[0] / (0.5 * width);
  return force / (flow / (kPi * (lumen * lumen - radius * radius)));
}

TEST(Drag, AlongACylinderIsThatOfFiniteVolumes)
{
  for (const double radius : {0.18e-3, 0.5e-3, 1.0e-3, 1.6e-3})
    EXPECT_NEAR(axialDrag(radius, 1.75e-3, kViscosity) / axialDragOfRings(radius, 1.75e-3, 4000), 1.0, 1e-3) << radius;
  EXPECT_THROW(axialDrag(2e-3, 1.75e-3, kViscosity), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::flow
