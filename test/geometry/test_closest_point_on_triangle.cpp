#include "geometry/closest_point_on_triangle.h"

#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::geometry
{
namespace
{

class TrianglePointTest : public testing::Test
{
protected:
  Eigen::Vector3d next()
  {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return {uniform(random_), uniform(random_), uniform(random_)};
  }
  std::mt19937 random_{11};
};

TEST_F(TrianglePointTest, IsNotFartherThanAnyPointOfAGrid)
{
  for (int trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d p = 2.0 * next(), a = next(), b = next(), c = next();
    const TrianglePoint closest = closestPointOnTriangle(p, a, b, c);
    const double distance = (closest.point - p).norm();
    double best = 1e9;
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j)
        best = std::min(best, (a + (b - a) * i / 60.0 + (c - a) * j / 60.0 - p).norm());
    EXPECT_LE(distance, best + 1e-12);
    EXPECT_GE(distance, best - 0.05);
  }
}

TEST_F(TrianglePointTest, ReportsTheFeatureOfTheClosestPoint)
{
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(closestPointOnTriangle({-1, -1, 1}, a, b, c).vertex, 0);
  EXPECT_EQ(closestPointOnTriangle({2, -0.1, 1}, a, b, c).vertex, 1);
  EXPECT_EQ(closestPointOnTriangle({0.5, -1, 0}, a, b, c).edge, 0);
  EXPECT_EQ(closestPointOnTriangle({1, 1, 0}, a, b, c).edge, 1);
  EXPECT_EQ(closestPointOnTriangle({-1, 0.5, 0}, a, b, c).edge, 2);
  const TrianglePoint inside = closestPointOnTriangle({0.2, 0.3, 5}, a, b, c);
  EXPECT_EQ(inside.edge, -1);
  EXPECT_EQ(inside.vertex, -1);
  EXPECT_LT((inside.point - Eigen::Vector3d(0.2, 0.3, 0.0)).norm(), 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::geometry
