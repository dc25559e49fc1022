#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "benchmark/reference/bore_equilibrium.h"

// Static force that pushes a wire through a rigid bore.

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kStiffness = 4e-5;  // N·m²

BoreAxis straight(double length, double spacing)
{
  BoreAxis axis;
  axis.curvature.assign(static_cast<std::size_t>(std::lround(length / spacing)), Eigen::Vector2d::Zero());
  axis.spacing = length / static_cast<double>(axis.curvature.size());
  return axis;
}

TEST(BoreEquilibrium, WithoutFrictionTheHandBearsTheLoad)
{
  EXPECT_DOUBLE_EQ(pushThroughBore({kStiffness, 4e-4, 0.0}, straight(0.1, 1e-3), 20.0), 20.0);
}

// The helix has the load c C²/(4B). Between two lengths, its ends, which bear less or more, cancel.
TEST(BoreEquilibrium, AHelixInAStraightBoreHasTheLoadOfTheClosedForm)
{
  const BoreWire wire = {kStiffness, 5e-5, 0.01};
  const double load = 40.0;
  const double shorter = pushThroughBore(wire, straight(0.06, 5e-4), load);
  const double longer = pushThroughBore(wire, straight(0.12, 5e-4), load);
  const double slope = wire.friction * wire.clearance / (4.0 * wire.stiffness);
  EXPECT_NEAR(1.0 / shorter - 1.0 / longer, slope * 0.06, 0.02 * slope * 0.06);
}

TEST(BoreEquilibrium, TheForceOfABuckledWireDoesNotDependOnTheStations)
{
  const BoreWire wire = {kStiffness, 4e-4, 0.1};
  const double coarse = pushThroughBore(wire, straight(0.1, 1e-3), 10.0);
  const double fine = pushThroughBore(wire, straight(0.1, 2.5e-4), 10.0);
  EXPECT_GT(fine, 12.0);
  EXPECT_NEAR(coarse, fine, 0.01 * fine);
}

TEST(BoreEquilibrium, ACompliantWireInABendHasTheForceOfACapstan)
{
  std::vector<Eigen::Vector3d> points;
  const double radius = 0.03;
  for (int i = 0; i <= 200; ++i)
  {
    const double angle = M_PI * i / 200.0;
    points.emplace_back(radius * (1.0 - std::cos(angle)), 0.0, radius * std::sin(angle));
  }
  const double quarter = 0.5 * M_PI * radius;
  const BoreWire wire = {1e-6, 1e-5, 0.2};
  const double half = pushThroughBore(wire, boreAxis(points, 0.25 * quarter, 0.75 * quarter, 1e-4), 0.5);
  const double whole = pushThroughBore(wire, boreAxis(points, 0.25 * quarter, 1.75 * quarter, 1e-4), 0.5);
  EXPECT_NEAR(std::log(whole / half), 0.2 * 0.5 * M_PI, 0.01 * 0.2 * 0.5 * M_PI);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
