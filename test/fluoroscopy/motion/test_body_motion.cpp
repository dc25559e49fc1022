#include "fluoroscopy/motion/body_motion.h"

#include <gtest/gtest.h>

#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Points of a lattice in a box widened by 5 %. */
std::vector<Eigen::Vector3d> pointsIn(const Eigen::AlignedBox3d& box, int steps)
{
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      for (int k = 0; k <= steps; ++k)
        points.emplace_back(box.center() + 1.05 * box.sizes().cwiseProduct(Eigen::Vector3d(i, j, k) / steps -
                                                                           Eigen::Vector3d::Constant(0.5)));
  return points;
}

TEST(BodyMotion, OfARestingMapReturnsItsArgument)
{
  const BodyMotion rest;
  EXPECT_TRUE(rest.resting());
  EXPECT_EQ(rest.pullBack({0.01, 0.02, 0.03}), Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_TRUE(motionAt(0.0, 0.0).resting());
  EXPECT_FALSE(largestMotion().resting());
}

TEST(BodyMotion, MovesTheHeartAsTheMapDoes)
{
  const BodyMotion motion = largestMotion();
  const motion::Fade& fade = motion.map().frame().fade;
  for (const Eigen::Vector3d& point : motion::pointsAround(motion.map().frame()))
  {
    if ((motion.map().pullBack(point) - fade.centre).norm() <= fade.core)
    {
      ASSERT_EQ(motion.pullBack(point), motion.map().pullBack(point));
    }
  }
}

TEST(BodyMotion, LowersTheRightDomeByTheDiaphragm)
{
  const BodyMotion motion = motionAt(0.0, motion::endInspiration());
  EXPECT_NEAR(motion.diaphragm(), 0.018, 1e-12);
  const DiaphragmField::Dome& right = motion.field().domes()[1];
  const Eigen::Vector3d lowered = right.top - Eigen::Vector3d(0.0, 0.0, motion.diaphragm());
  const Eigen::Vector3d rest = motion.pullBack(lowered);
  EXPECT_NEAR(rest.x(), right.top.x(), 1e-3);
  EXPECT_NEAR(rest.z(), right.top.z(), 2e-3);
  EXPECT_LT(right.top.x(), motion.map().frame().base.x());  // x points to the left
  EXPECT_GT(right.top.z(), motion.field().domes()[0].top.z());
}

TEST(BodyMotion, LeavesWhatIsOutsideOfItsBoxAndItsClippedLines)
{
  const BodyMotion motion = largestMotion();
  const Eigen::Vector3d source = motion.box().center() + Eigen::Vector3d(0.1, 0.7, 0.2);
  int inside = 0, outside = 0;
  for (const Eigen::Vector3d& point : pointsIn(motion.box(), 24))
  {
    const bool moves = motion.pullBack(point) != point;
    double begin = 0.0, end = 0.0;
    const bool meets = motion.clip(source, point - source, begin, end);
    const bool within = meets && begin <= 1.0 && 1.0 <= end;
    (moves ? inside : outside) += 1;
    ASSERT_TRUE(!moves || (within && motion.box().contains(point))) << point.transpose();
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

TEST(BodyMotion, NeitherFoldsNorTearsTheBody)
{
  const BodyMotion motion = largestMotion();
  const double step = 1e-5;
  double least = 1.0;
  for (const Eigen::Vector3d& point : pointsIn(motion.box(), 40))
  {
    Eigen::Matrix3d gradient;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Eigen::Vector3d offset = step * Eigen::Vector3d::Unit(axis);
      gradient.col(axis) = (motion.pullBack(point + offset) - motion.pullBack(point - offset)) / (2.0 * step);
      ASSERT_LT(gradient.col(axis).norm(), 3.0);
    }
    least = std::min(least, gradient.determinant());
  }
  EXPECT_GT(least, 0.2);
}

TEST(BodyMotion, PullsManyPointsBackWithTheBitsOfSingleOnes)
{
  const BodyMotion motion = largestMotion();
  const std::vector<Eigen::Vector3d> points = pointsIn(motion.box(), 9);
  std::vector<Eigen::Vector3d> rest;
  motion.pullBack(points, rest);
  for (std::size_t k = 0; k < points.size(); ++k)
    ASSERT_EQ(rest[k], motion.pullBack(points[k]));
}

TEST(BodyMotion, EqualsAnotherOnlyWithEqualMapAndDiaphragm)
{
  EXPECT_EQ(motionAt(0.2, 0.1), motionAt(0.2, 0.1));
  EXPECT_NE(motionAt(0.2, 0.1), motionAt(0.2, 0.11));
  EXPECT_NE(motionAt(0.2, 0.1), motionAt(0.21, 0.1));
  const BodyMotion motion = motionAt(0.2, 0.1);
  EXPECT_NE(motion, BodyMotion(motion.map(), 0.0));
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
