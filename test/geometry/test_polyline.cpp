#include "geometry/polyline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace endovascular_sim::geometry
{
namespace
{

/** L-shaped polyline of 3 m and 4 m with a duplicate corner. */
Polyline corner()
{
  return Polyline({{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 4, 0}});
}

TEST(Polyline, EvaluatesByArcLengthAndClampsToItsEnds)
{
  const Polyline line = corner();
  EXPECT_EQ(line.length(), 7.0);
  EXPECT_EQ(line.at(1.5), Eigen::Vector3d(1.5, 0, 0));
  EXPECT_EQ(line.at(5.0), Eigen::Vector3d(3, 2, 0));
  EXPECT_EQ(line.at(-1.0), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(line.at(9.0), Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(line.tangentAt(1.0), Eigen::Vector3d::UnitX());
  EXPECT_EQ(line.tangentAt(8.0), Eigen::Vector3d::UnitY());
  EXPECT_EQ(line.interpolate({1.0, 4.0, 8.0}, 5.0), 6.0);
}

TEST(Polyline, FindsTheClosestPoint)
{
  const Polyline::Foot foot = corner().nearest({2.0, 3.0, 0.5});
  EXPECT_EQ(foot.point, Eigen::Vector3d(3, 3, 0));
  EXPECT_EQ(foot.arc, 6.0);
  EXPECT_NEAR(foot.distance, std::sqrt(1.25), 1e-15);
}

TEST(Polyline, NormalPlaneFootIsContinuousBesideABend)
{
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k <= 10; ++k)
    points.emplace_back(1.0 - std::cos(0.1 * k), std::sin(0.1 * k), 0.0);
  const Polyline arc(points);
  // On concentric circles inside and outside, the arc length of the foot equals the angle.
  for (double radius : {0.5, 1.5})
    for (int k = 30; k <= 170; ++k)
    {
      const double angle = 0.005 * k;
      const Polyline::Foot foot = arc.normalPlaneFoot({1.0 - radius * std::cos(angle), radius * std::sin(angle), 0.0});
      EXPECT_NEAR(foot.arc, angle, 1e-3);
      EXPECT_NEAR(foot.distance, 0.5, 2e-3);
      EXPECT_NEAR(foot.tangent.x(), std::sin(angle), 0.06);
    }
}

TEST(Polyline, PartRetainsThePointsInBetween)
{
  const Polyline part = corner().part(1.0, 5.0);
  EXPECT_EQ(part.length(), 4.0);
  EXPECT_EQ(part.points().front(), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(part.points().back(), Eigen::Vector3d(3, 2, 0));
  EXPECT_EQ(part.at(2.0), Eigen::Vector3d(3, 0, 0));
}

}  // namespace
}  // namespace endovascular_sim::geometry
