#include "motion/map/motion_map.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "test/motion/motion_fixtures.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

bool sameBits(const Vector3d& a, const Vector3d& b)
{
  return std::memcmp(a.data(), b.data(), sizeof(double) * 3) == 0;
}

/** Largest error of central differences of positions against the gradient over the points. */
double gradientError(const MotionMap& map, double step)
{
  double largest = 0.0;
  for (const Vector3d& point : pointsAround(map.frame()))
    for (int j = 0; j < 3; ++j)
    {
      const Vector3d offset = step * Vector3d::Unit(j);
      const Vector3d difference = (map.position(point + offset) - map.position(point - offset)) / (2.0 * step);
      largest = std::max(largest, (difference - map.gradient(point).col(j)).norm());
    }
  return largest;
}

TEST(MotionMap, HasTheGradientOfCentralDifferencesWithSecondOrder)
{
  const MotionMap map = mapAt(endSystole(), endInspiration());
  const double coarse = gradientError(map, 2e-3), fine = gradientError(map, 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
  EXPECT_LT(gradientError(map, 1e-6), 1e-8);
}

TEST(MotionMap, HasContinuousSecondDerivativesAcrossBothEndsOfTheFade)
{
  // One-sided second differences at either side of a sphere differ by the jump, or vanish with the step.
  const MotionMap map = mapAt(endSystole(), endInspiration());
  const Fade& fade = map.frame().fade;
  for (const double radius : {fade.core, fade.reach})
    for (const Vector3d& direction : {Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(0.6, 0.0, -0.8)})
    {
      const auto displacement = [&](double r) { return map.displacement(fade.centre + r * direction); };
      double jumps[2];
      for (int k = 0; k < 2; ++k)
      {
        const double h = k == 0 ? 4e-5 : 2e-5;
        const auto second = [&](double r)
        { return Vector3d((displacement(r + h) - 2.0 * displacement(r) + displacement(r - h)) / (h * h)); };
        jumps[k] = (second(radius + h) - second(radius - h)).norm();
      }
      EXPECT_LT(jumps[0], 1.0) << "at " << radius;  // of some 25 /m within the fade
      EXPECT_LT(jumps[1], 0.6 * jumps[0]) << "at " << radius;
    }
}

TEST(MotionMap, IsInvertedByPullingBack)
{
  for (const double heart : {0.1, 0.25, endSystole(), 0.6, 0.9})
    for (const double breath : {0.0, 0.2, endInspiration()})
    {
      const MotionMap map = mapAt(heart, breath);
      for (const Vector3d& point : pointsAround(map.frame()))
      {
        EXPECT_LT((map.pullBack(map.position(point)) - point).norm(), 1e-12);
        EXPECT_LT((map.position(map.pullBack(point)) - point).norm(), 1e-12);
      }
    }
}

TEST(MotionMap, HasTheSameBitsForManyPointsAsForEach)
{
  const MotionMap map = mapAt(0.3, 0.3);
  const std::vector<Vector3d> points = pointsAround(map.frame(), 5);
  std::vector<Vector3d> moved, rest;
  map.positions(points, moved);
  map.pullBack(moved, rest);
  ASSERT_EQ(moved.size(), points.size());
  ASSERT_EQ(rest.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    EXPECT_TRUE(sameBits(moved[k], map.position(points[k])));
    EXPECT_TRUE(sameBits(rest[k], map.pullBack(moved[k])));
  }
}

TEST(MotionMap, OfAFieldOfZerosReturnsEveryPointBitForBit)
{
  MotionSettings settings = adultMotion();
  settings.heart.base_displacement = settings.heart.radial_shortening = 0.0;
  settings.heart.base_rotation = settings.heart.apex_rotation = 0.0;
  settings.breathing.translation.setZero();
  settings.breathing.rotation.setZero();
  for (const MotionMap& map : {mapAt(0.3, 0.3, naturalHeart(), settings), mapAt(0.0, 0.0)})
  {
    EXPECT_TRUE(map.resting());
    std::vector<Vector3d> points = pointsAround(map.frame()), rest;
    points.emplace_back(-0.0, map.frame().fade.centre.y(), map.frame().fade.centre.z());
    map.pullBack(points, rest);
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      EXPECT_TRUE(sameBits(map.position(points[k]), points[k]));
      EXPECT_TRUE(sameBits(map.pullBack(points[k]), points[k]));
      EXPECT_TRUE(sameBits(rest[k], points[k]));
      EXPECT_EQ(map.gradient(points[k]), Matrix3d(Matrix3d::Identity()));
    }
  }
}

TEST(MotionMap, LeavesPointsBeyondTheFadeWhereTheyAreBitForBit)
{
  const MotionMap map = mapAt(endSystole(), endInspiration());
  int outside = 0;
  for (const Vector3d& point : pointsAround(map.frame()))
    if (map.outside(point))
    {
      ++outside;
      EXPECT_TRUE(sameBits(map.position(point), point));
      EXPECT_TRUE(sameBits(map.pullBack(point), point));
      EXPECT_EQ(map.velocity(point), Vector3d(Vector3d::Zero()));
    }
  EXPECT_GT(outside, 100);
}

TEST(MotionMap, HasTheVelocityOfDifferencesOfPositionsInTime)
{
  const HeartFrame frame = naturalHeart();
  MotionSettings settings = adultMotion();
  settings.breathing.rotation = Vector3d(0.3, 0.2, -0.1);  // [rad] large, so that it is no small rotation
  const double step = 1e-6;                                // [s]
  for (const double heart : {0.05, 0.2, 0.33, 0.5, 0.7, 0.95})
    for (const double breath : {0.1, 0.3, 0.6})
    {
      const auto at = [&](double time)
      { return mapAt(heart + time * settings.heart.rate, breath + time * settings.breathing.rate, frame, settings); };
      const MotionMap before = at(-step), map = at(0.0), after = at(step);
      for (const Vector3d& point : pointsAround(frame, 3))
      {
        const Vector3d difference = (after.position(point) - before.position(point)) / (2.0 * step);
        EXPECT_LT((difference - map.velocity(point)).norm(), 1e-6);
      }
    }
}

TEST(MotionMap, MovesTheHeartAsOneRigidBodyWithABreath)
{
  const MotionMap map = mapAt(0.0, endInspiration());
  const RespiratoryMotion breathing = adultMotion().breathing;
  const HeartFrame& frame = map.frame();
  const Vector3d middle = frame.base + 0.5 * frame.length * frame.axis;
  std::vector<Vector3d> inside;
  for (const Vector3d& point : pointsAround(frame, 10))
    if ((point - frame.fade.centre).norm() < frame.fade.core)
      inside.push_back(point);
  ASSERT_GT(inside.size(), 300U);
  const double angle = breathing.rotation.norm();
  for (const Vector3d& point : inside)
  {
    for (const Vector3d& other : {inside.front(), inside.back()})
      EXPECT_NEAR((map.position(point) - map.position(other)).norm(), (point - other).norm(), 1e-14);
    const Matrix3d gradient = map.gradient(point);
    EXPECT_LT((gradient.transpose() * gradient - Matrix3d::Identity()).norm(), 1e-14);
    // The share of the rotation is the tangent of the half angle, 1 at end-inspiration.
    const Eigen::AngleAxisd turn(2.0 * std::atan(0.5 * angle), breathing.rotation / angle);
    EXPECT_LT((map.position(point) - (turn * (point - middle) + middle + breathing.translation)).norm(), 1e-14);
  }
}

TEST(MotionMap, TurnsWithTheHeart)
{
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(1.1, Vector3d(1, 2, -2).normalized());
  const MotionSettings settings = adultMotion();
  MotionSettings turned = settings;
  turned.breathing.translation = pose.linear() * settings.breathing.translation;
  turned.breathing.rotation = pose.linear() * settings.breathing.rotation;
  HeartFrame frame = naturalHeart(), turned_frame = frame;
  turned_frame.base = pose * frame.base;
  turned_frame.axis = pose.linear() * frame.axis;
  turned_frame.fade.centre = pose * frame.fade.centre;
  const MotionMap map = mapAt(0.3, 0.3, frame, settings), other = mapAt(0.3, 0.3, turned_frame, turned);
  for (const Vector3d& point : pointsAround(frame))
  {
    EXPECT_LT((pose * map.position(point) - other.position(pose * point)).norm(), 1e-14);
    EXPECT_LT((pose * map.pullBack(point) - other.pullBack(pose * point)).norm(), 1e-14);
    EXPECT_LT((pose.linear() * map.velocity(point) - other.velocity(pose * point)).norm(), 1e-13);
  }
}

TEST(MotionMap, IsMirroredWithTheHeartWhenRotationsChangeTheirSigns)
{
  const Matrix3d mirror = Vector3d(-1, 1, 1).asDiagonal();
  const MotionSettings settings = adultMotion();
  MotionSettings mirrored = settings;
  mirrored.heart.base_rotation *= -1.0;
  mirrored.heart.apex_rotation *= -1.0;
  mirrored.breathing.translation = mirror * settings.breathing.translation;
  mirrored.breathing.rotation = -(mirror * settings.breathing.rotation);
  HeartFrame frame = naturalHeart(), other_frame = frame;
  other_frame.base = mirror * frame.base;
  other_frame.axis = mirror * frame.axis;
  other_frame.fade.centre = mirror * frame.fade.centre;
  const MotionMap map = mapAt(0.3, 0.3, frame, settings), other = mapAt(0.3, 0.3, other_frame, mirrored);
  for (const Vector3d& point : pointsAround(frame))
  {
    EXPECT_LT((mirror * map.position(point) - other.position(mirror * point)).norm(), 1e-15);
    EXPECT_LT((mirror * map.pullBack(point) - other.pullBack(mirror * point)).norm(), 1e-14);
  }
}

TEST(MotionMap, PushesPlanesForwardWithTheirNormalsAndGaps)
{
  const MotionMap map = mapAt(endSystole(), endInspiration());
  for (const Vector3d& point : pointsAround(map.frame(), 3))
    for (const Vector3d& normal : {Vector3d(1, 0, 0), Vector3d(0.48, -0.6, 0.64)})
    {
      const MotionMap::Feature feature = map.pushForward(point, normal);
      EXPECT_EQ(feature.point, map.position(point));
      EXPECT_NEAR(feature.normal.norm(), 1.0, 1e-14);
      EXPECT_LT((map.restingNormal(point, feature.normal) - normal).norm(), 1e-14);
      const Vector3d along = normal.unitOrthogonal();
      for (const Vector3d& tangent : {along, Vector3d(normal.cross(along))})
        EXPECT_NEAR(feature.normal.dot(map.gradient(point) * tangent), 0.0, 1e-14);
      // A point whose gap at rest is g has the gap g · distance_scale, with an error of second order.
      double errors[2];
      for (int k = 0; k < 2; ++k)
      {
        const double gap = k == 0 ? 1e-4 : 5e-5;
        const Vector3d moved = map.position(point + gap * (normal + 0.3 * along));
        errors[k] = feature.normal.dot(moved - feature.point) - gap * feature.distance_scale;
        EXPECT_LT(std::abs(errors[k]), 40.0 * gap * gap);
      }
    }
}

}  // namespace
}  // namespace endovascular_sim::motion
