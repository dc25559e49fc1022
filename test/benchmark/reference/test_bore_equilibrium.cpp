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

Bore straight(double length, double spacing, double clearance, double friction)
{
  Bore bore;
  bore.stations.assign(static_cast<std::size_t>(std::lround(length / spacing)), {clearance, friction});
  bore.spacing = length / static_cast<double>(bore.stations.size());
  return bore;
}

TEST(BoreEquilibrium, WithoutFrictionTheHandBearsTheLoad)
{
  EXPECT_DOUBLE_EQ(pushThroughBore(kStiffness, straight(0.1, 1e-3, 4e-4, 0.0), {20.0}), 20.0);
}

// The helix has the load c C²/(4B). Between two lengths, its ends, which bear less or more, cancel.
TEST(BoreEquilibrium, AHelixInAStraightBoreHasTheLoadOfTheClosedForm)
{
  const double clearance = 5e-5;
  const double friction = 0.01;
  const double load = 40.0;
  const double shorter = pushThroughBore(kStiffness, straight(0.06, 5e-4, clearance, friction), {load});
  const double longer = pushThroughBore(kStiffness, straight(0.12, 5e-4, clearance, friction), {load});
  const double slope = friction * clearance / (4.0 * kStiffness);
  EXPECT_NEAR(1.0 / shorter - 1.0 / longer, slope * 0.06, 0.02 * slope * 0.06);
}

TEST(BoreEquilibrium, TheForceOfABuckledWireDoesNotDependOnTheStations)
{
  const double coarse = pushThroughBore(kStiffness, straight(0.1, 1e-3, 4e-4, 0.1), {10.0});
  const double fine = pushThroughBore(kStiffness, straight(0.1, 2.5e-4, 4e-4, 0.1), {10.0});
  EXPECT_GT(fine, 12.0);
  EXPECT_NEAR(coarse, fine, 0.01 * fine);
}

// At the end of a narrow bore a force across is borne by the wall; its arm beyond the bore is a couple.
TEST(BoreEquilibrium, AForceOnAPartBeyondTheBoreIsAForceAndACoupleAtItsEnd)
{
  const double friction = 0.1;
  const Bore bore = straight(0.05, 2.5e-4, 1e-5, friction);
  BoreEndLoad load;
  load.across = Eigen::Vector2d(0.3, 0.4);
  EXPECT_NEAR(pushThroughBore(kStiffness, bore, load), 0.5 * friction, 0.01 * 0.5 * friction);

  Bore longer = bore;
  longer.stations.resize(bore.stations.size() + 8, {1e-2, 0.0});
  BoreEndLoad equivalent = load;
  equivalent.couple = 8 * bore.spacing * load.across;
  const double force = pushThroughBore(kStiffness, longer, load);
  EXPECT_GT(force, friction);
  EXPECT_NEAR(pushThroughBore(kStiffness, bore, equivalent), force, 0.01 * force);
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
  const BoreStation station = {1e-5, 0.2};
  const double half = pushThroughBore(1e-6, boreAlong(points, 0.25 * quarter, 0.75 * quarter, 1e-4, station), {0.5});
  const double whole = pushThroughBore(1e-6, boreAlong(points, 0.25 * quarter, 1.75 * quarter, 1e-4, station), {0.5});
  EXPECT_NEAR(std::log(whole / half), 0.2 * 0.5 * M_PI, 0.01 * 0.2 * 0.5 * M_PI);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
