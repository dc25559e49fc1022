#include "motion/map/map_bounds.h"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "test/motion/motion_fixtures.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(SecondDerivativesOfTheMap, AreThoseOfDifferencesOfTheGradient)
{
  const MotionMap map = mapAt(endSystole(), endInspiration());
  const double step = 1e-5;
  for (const Vector3d& point : pointsAround(map.frame()))
  {
    const SecondDerivatives second = secondDerivatives(map, point);
    for (int j = 0; j < 3; ++j)
    {
      const Vector3d offset = step * Vector3d::Unit(j);
      const Matrix3d slope = (map.gradient(point + offset) - map.gradient(point - offset)) / (2.0 * step);
      for (int i = 0; i < 3; ++i)
        EXPECT_LT((slope.row(i) - second[static_cast<std::size_t>(i)].row(j)).norm(), 0.05);
    }
  }
}

TEST(SecondDerivativesOfTheInverse, AreThoseOfDifferencesOfPointsThatArePulledBack)
{
  const MotionMap map = mapAt(endSystole(), endInspiration());
  const double step = 1e-4;
  for (const Vector3d& point : pointsAround(map.frame(), 4))
  {
    const SecondDerivatives second =
        inverseSecondDerivatives(secondDerivatives(map, point), map.gradient(point).inverse());
    const Vector3d moved = map.position(point);
    for (const Vector3d& along : {Vector3d(1, 0, 0), Vector3d(0.6, 0, 0.8)})
    {
      const Vector3d difference =
          (map.pullBack(moved + step * along) - 2.0 * point + map.pullBack(moved - step * along)) / (step * step);
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(difference[i], along.dot(second[static_cast<std::size_t>(i)] * along), 0.5);
    }
  }
}

TEST(BoundsOfTheMap, OfAnAdultAreFarFromFolding)
{
  const PatientMotion motion(naturalHeart(), adultMotion());
  const MapBounds bounds = motionBounds(motion, gridOf(motion.frame().fade, 8e-3));
  EXPECT_GT(bounds.determinant, 0.5);
  EXPECT_LT(bounds.gradient, 0.9);
  EXPECT_LT(bounds.round_trip, 1e-12);
  EXPECT_LT(bounds.displacement, 0.025);
  EXPECT_LT(bounds.speed, 0.15);
}

TEST(BoundsOfTheMap, AllowEdgesOfTwoMillimetresInTheLumenASagOfFewHundredthsOfAMillimetre)
{
  const MapBounds bounds = motionBounds(PatientMotion(naturalHeart(), adultMotion()), lumenPoints(naturalCentreline()));
  EXPECT_LT(bounds.sag(2e-3), 30e-6);
  EXPECT_GT(bounds.sag(2e-3), 5e-6);
  EXPECT_LT(bounds.gradient, 0.8);
}

TEST(BoundsOfTheMap, AreNearlyThoseOfAFinerGrid)
{
  const MotionMap map = mapAt(endSystole(), endInspiration());
  const Fade& fade = map.frame().fade;
  const MapBounds coarse = mapBounds(map, gridOf(fade, fade.width() / 6.0)), fine = mapBounds(map, gridOf(fade, 3e-3));
  EXPECT_NEAR(coarse.determinant, fine.determinant, 0.03);
  EXPECT_NEAR(coarse.gradient, fine.gradient, 0.03);
  EXPECT_NEAR(coarse.curvature, fine.curvature, 0.1 * fine.curvature);
  EXPECT_NEAR(coarse.inverse_curvature, fine.inverse_curvature, 0.1 * fine.inverse_curvature);
}

TEST(BoundsOfTheMap, BoundTheSagOfEdgesThatArePulledBack)
{
  const MotionMap map = mapAt(endSystole(), endInspiration());
  const MapBounds bounds = mapBounds(map, gridOf(map.frame().fade, 5e-3));
  double largest = 0.0;
  const double edge = 4e-3;
  for (const Vector3d& point : pointsAround(map.frame(), 10))
    for (const Vector3d& direction : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(0.6, 0.8, 0.0)})
    {
      const Vector3d half = 0.5 * edge * direction;
      const Vector3d begin = map.pullBack(point - half), end = map.pullBack(point + half);
      largest = std::max(largest, (map.pullBack(point) - 0.5 * (begin + end)).norm());
    }
  EXPECT_LT(largest, bounds.sag(edge));
  EXPECT_GT(largest, 0.1 * bounds.sag(edge));
  EXPECT_DOUBLE_EQ(bounds.sag(2e-3), 0.25 * bounds.sag(4e-3));
}

TEST(BoundsOfTheMap, BoundTheStretchOfShortLengths)
{
  const MotionMap map = mapAt(endSystole(), endInspiration());
  const MapBounds bounds = mapBounds(map, gridOf(map.frame().fade, 5e-3));
  double least = 1.0, largest = 1.0;
  for (const Vector3d& point : pointsAround(map.frame(), 8))
    for (const Vector3d& direction :
         {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(0.6, -0.8, 0.0)})
    {
      const double stretch = (map.position(point + 1e-6 * direction) - map.position(point)).norm() / 1e-6;
      least = std::min(least, stretch);
      largest = std::max(largest, stretch);
    }
  EXPECT_GT(least, bounds.least_stretch - 0.01);
  EXPECT_LT(least, bounds.least_stretch + 0.1);
  EXPECT_LT(largest, bounds.largest_stretch + 0.01);
  EXPECT_GT(largest, bounds.largest_stretch - 0.1);
}

TEST(BoundsOfTheMap, ShowTheFoldsOfATooLargeMotion)
{
  const HeartFrame frame = naturalHeart();
  MotionField field;
  field.shift = Vector3d(0.0, 0.0, -0.04);
  EXPECT_LT(mapBounds(MotionMap(frame, field, {}), gridOf(frame.fade, 5e-3)).determinant, 0.0);
  field.shift *= 0.25;
  // Only the weight varies: the least determinant is that of its steepest slope.
  const MapBounds bounds = mapBounds(MotionMap(frame, field, {}), gridOf(frame.fade, 3e-3));
  EXPECT_NEAR(bounds.determinant, 1.0 - bounds.gradient, 1e-2);
  EXPECT_NEAR(bounds.gradient, 0.01 * 1.875 / frame.fade.width(), 0.08 * bounds.gradient);
}

}  // namespace
}  // namespace endovascular_sim::motion
