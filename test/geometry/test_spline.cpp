#include "geometry/spline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace endovascular_sim::geometry
{
namespace
{

std::vector<Eigen::Vector3d> points()
{
  return {{0, 0, 0}, {1, 0.2, 0}, {2, 1, 0.5}, {2.5, 2, 1}, {2.2, 3.4, 1.2}};
}

TEST(Spline, InterpolatesItsPoints)
{
  const Spline3 spline(points());
  for (std::size_t k = 0; k < points().size(); ++k)
    EXPECT_LT((spline.position(spline.knots()[k]) - points()[k]).norm(), 1e-14);
}

TEST(Spline, DerivativeAgreesWithFiniteDifferences)
{
  const Spline3 spline(points());
  const double h = 1e-6;
  for (double u = 0.1; u < spline.knots().back() - 0.1; u += 0.137)
  {
    const Eigen::Vector3d difference = (spline.position(u + h) - spline.position(u - h)) / (2.0 * h);
    EXPECT_LT((difference - spline.derivative(u)).norm(), 1e-8);
  }
}

TEST(Spline, HasContinuousCurvatureAtItsKnots)
{
  const Spline3 spline(points());
  const double h = 1e-5;
  for (std::size_t k = 1; k + 1 < points().size(); ++k)
  {
    const double u = spline.knots()[k];
    const Eigen::Vector3d before = (spline.derivative(u) - spline.derivative(u - h)) / h;
    const Eigen::Vector3d after = (spline.derivative(u + h) - spline.derivative(u)) / h;
    EXPECT_LT((before - after).norm(), 1e-3);
  }
}

TEST(Spline, IsASegmentForTwoPoints)
{
  const Spline3 spline({{0, 0, 0}, {3, 4, 0}});
  EXPECT_LT((spline.position(2.5) - Eigen::Vector3d(1.5, 2, 0)).norm(), 1e-14);
}

TEST(MonotoneCubic, InterpolatesItsValuesWithoutOvershoot)
{
  const MonotoneCubic f({0, 1, 2, 5}, {3, 3, 1, 0.5});
  EXPECT_EQ(f(-1), 3);
  EXPECT_EQ(f(9), 0.5);
  EXPECT_DOUBLE_EQ(f(2), 1);
  double last = f(0);
  for (double x = 0; x <= 5; x += 0.01)
  {
    EXPECT_LE(f(x), last + 1e-12);
    EXPECT_GE(f(x), 0.5 - 1e-12);
    last = f(x);
  }
}

}  // namespace
}  // namespace endovascular_sim::geometry
