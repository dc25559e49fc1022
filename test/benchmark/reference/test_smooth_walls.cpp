#include "benchmark/reference/smooth_walls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace endovascular_sim::benchmark
{
namespace
{

contact::ContactSet contactsAt(SmoothWall& wall, const Eigen::Vector3d& point)
{
  contact::Query query;
  query.first_node = 5;
  query.nodes = {point, Eigen::Vector3d(1e-3, 2e-4, 3e-4)};
  query.radius = {1e-4, 1e-4};
  contact::ContactSet set;
  wall.detect(query, set);
  return set;
}

/** Expects the normal to be the gradient of the gap, and the closest point at the distance of the gap. */
void expectConsistent(SmoothWall& wall, const Eigen::Vector3d& point)
{
  const contact::Feature feature = contactsAt(wall, point).features.front();
  EXPECT_EQ(feature.edge, 5);
  EXPECT_EQ(feature.parameter, 0.0);
  EXPECT_NEAR(feature.normal.norm(), 1.0, 1e-14);
  EXPECT_NEAR((point - feature.gap * feature.normal - feature.point).norm(), 0.0, 1e-14);
  const double step = 1e-7;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Eigen::Vector3d shift = step * Eigen::Vector3d::Unit(axis);
    const double slope =
        (contactsAt(wall, point + shift).features.front().gap - contactsAt(wall, point - shift).features.front().gap) /
        (2.0 * step);
    EXPECT_NEAR(slope, feature.normal[axis], 1e-4) << axis;
  }
}

TEST(SmoothWalls, NormalsAreTheGradientsOfTheGaps)
{
  FlatChannel channel(2e-3);
  expectConsistent(channel, Eigen::Vector3d(0.01, 5e-4, 1e-4));
  Peg peg(Eigen::Vector3d(0.0, -0.02, 0.0), 0.02, 0.3);
  expectConsistent(peg, Eigen::Vector3d(0.004, 5e-4, 1e-4));
  BentTube tube(1e-3, 0.02, 0.03, 2.2);
  for (const double turn : {0.1, 1.0, 2.0})
    expectConsistent(tube, Eigen::Vector3d(0.02 + 0.0304 * std::sin(turn), 0.03 - 0.0304 * std::cos(turn), 3e-4));
  expectConsistent(tube, Eigen::Vector3d(0.01, -4e-4, 3e-4));
}

TEST(SmoothWalls, GapInABentTubeIsTheClearanceMinusTheDistanceToItsAxis)
{
  const double angle = 2.2;
  BentTube tube(1e-3, 0.02, 0.03, angle);
  const Eigen::Vector3d end(0.02 + 0.03 * std::sin(angle), 0.03 - 0.03 * std::cos(angle), 0.0);
  const Eigen::Vector3d beyond(std::cos(angle), std::sin(angle), 0.0);
  for (int k = 0; k < 40; ++k)
  {
    const double s = 0.003 * k;
    const double turn = std::min(angle, std::max(0.0, (s - 0.02) / 0.03));
    Eigen::Vector3d axis(std::min(s, 0.02) + 0.03 * std::sin(turn), 0.03 - 0.03 * std::cos(turn), 0.0);
    if (s > 0.02 + 0.03 * angle)
      axis = end + (s - 0.02 - 0.03 * angle) * beyond;
    const Eigen::Vector3d across(-std::sin(turn), std::cos(turn), 0.0);
    const Eigen::Vector3d offset = 3e-4 * across + 4e-4 * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(contactsAt(tube, axis + offset).features.front().gap, 5e-4, 1e-12) << s;
  }
}

TEST(SmoothWalls, ListTheLastNodeAtTheEndOfItsEdge)
{
  BentTube tube(1e-3, 0.0, std::numeric_limits<double>::infinity(), 0.0);
  const contact::ContactSet set = contactsAt(tube, Eigen::Vector3d(0.0, 5e-4, 0.0));
  ASSERT_EQ(set.features.size(), 2U);
  EXPECT_EQ(set.features[1].edge, 5);
  EXPECT_EQ(set.features[1].parameter, 1.0);
  EXPECT_EQ(set.first_edge, 5);
  EXPECT_EQ(set.free_distance.size(), 1U);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
