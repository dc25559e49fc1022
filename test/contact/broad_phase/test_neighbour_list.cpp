#include "contact/broad_phase/neighbour_list.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "contact/narrow_phase/narrow_phase.h"
#include "geometry/loop_subdivision.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kCutoff = 0.7e-3;  // m

/** A list of an edge along the wall of a tube. */
class NeighbourListInATube : public testing::Test
{
protected:
  void follow(const Eigen::Vector3d& displacement, double cutoff = kCutoff)
  {
    list_.follow(a_ + displacement, b_ + displacement, cutoff);
  }

  void update(const Eigen::Vector3d& displacement, double cutoff = kCutoff)
  {
    follow(displacement, cutoff);
    list_.update(bvh_, bounds_, a_ + displacement, b_ + displacement, cutoff, scratch_);
    follow(displacement, cutoff);
  }

  bool isValidAt(const Eigen::Vector3d& displacement, double cutoff = kCutoff)
  {
    follow(displacement, cutoff);
    return list_.isValid();
  }

  /** Builds the first list and, off its skin, a second one. @return displacement at which the second was built */
  Eigen::Vector3d buildTwice()
  {
    update(Eigen::Vector3d::Zero());
    const Eigen::Vector3d off(0.0, 0.06e-3, 0.0);
    update(off);
    return off;
  }

  Wall wall_{geometry::midpointSubdivision(bentTube(), 3)};
  WallBounds bounds_{wall_};
  Bvh bvh_{wall_};
  NeighbourList list_;
  NeighbourList::Scratch scratch_;
  Eigen::Vector3d a_{3.3e-3, 0.0, 10e-3};
  Eigen::Vector3d b_{3.3e-3, 0.0, 11.5e-3};
};

TEST_F(NeighbourListInATube, IsInvalidUntilItIsBuilt)
{
  EXPECT_FALSE(isValidAt(Eigen::Vector3d::Zero()));
  update(Eigen::Vector3d::Zero());
  EXPECT_TRUE(list_.isValid());
  EXPECT_TRUE(list_.hasTriangles());
}

TEST_F(NeighbourListInATube, IsValidWithinItsSkin)
{
  update(Eigen::Vector3d::Zero());
  EXPECT_TRUE(isValidAt({0.0, 0.049e-3, 0.0}));
  EXPECT_FALSE(isValidAt({0.0, 0.051e-3, 0.0})) << "the first skin is 0.05 mm";
  const Eigen::Vector3d at = buildTwice();
  EXPECT_TRUE(isValidAt(at + Eigen::Vector3d(0.0, 0.149e-3, 0.0)));
  EXPECT_FALSE(isValidAt(at + Eigen::Vector3d(0.0, 0.151e-3, 0.0))) << "later skins are 0.15 mm";
}

TEST_F(NeighbourListInATube, IsValidForCutoffsBelowItsOwn)
{
  update(Eigen::Vector3d::Zero());
  EXPECT_FALSE(isValidAt(Eigen::Vector3d::Zero(), kCutoff + 1e-6));
  EXPECT_TRUE(isValidAt(Eigen::Vector3d::Zero(), kCutoff - 0.5e-3));
  EXPECT_FALSE(isValidAt(Eigen::Vector3d::Zero(), kCutoff - 0.65e-3)) << "the list would be needlessly long";
}

TEST_F(NeighbourListInATube, HasALargerSkinAfterASnapThrough)
{
  buildTwice();
  const Eigen::Vector3d snapped(0.0, 0.5e-3, 0.0);
  update(snapped);
  EXPECT_TRUE(isValidAt(snapped + Eigen::Vector3d(0.0, 0.25e-3, 0.0)));
}

TEST_F(NeighbourListInATube, CoversAnIntervalAlongTheWireAfterItHasSlid)
{
  const Eigen::Vector3d slid = buildTwice() + Eigen::Vector3d(0.0, 0.0, 0.19e-3);
  update(slid);
  EXPECT_TRUE(isValidAt(slid + Eigen::Vector3d(0.0, 0.0, 0.35e-3)));
  EXPECT_FALSE(isValidAt(slid - Eigen::Vector3d(0.0, 0.0, 0.2e-3))) << "the interval lies ahead of the node";
}

TEST_F(NeighbourListInATube, ContainsEveryTriangleOfAMinimumWhileTheWireMovesWithinTheSkin)
{
  const NarrowPhase narrow_phase(wall_, bounds_);
  const Eigen::Vector3d at = buildTwice();
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  NarrowPhase::Minimum minimum;
  int minima = 0;
  for (int trial = 0; trial < 200; ++trial)
  {
    const Eigen::Vector3d displacement =
        at + 0.08e-3 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    ASSERT_TRUE(isValidAt(displacement));
    std::vector<int> visited;
    list_.forEachTriangle(a_ + displacement, kCutoff, [&](int t) { visited.push_back(t); });
    EXPECT_TRUE(std::is_sorted(visited.begin(), visited.end()));
    for (int t = 0; t < static_cast<int>(wall_.triangles.size()); ++t)
      if (narrow_phase.faceFeature(a_ + displacement, t, kCutoff, minimum))
      {
        // Features on a border are reported by their owner at least.
        EXPECT_TRUE(std::binary_search(visited.begin(), visited.end(), minimum.feature.triangle)) << t;
        ++minima;
      }
  }
  EXPECT_GT(minima, 200);
}

TEST_F(NeighbourListInATube, BecomesInvalidWhenTheWallHasMovedByItsSkin)
{
  const Eigen::Vector3d at = buildTwice();
  NeighbourList::WallMovement movement;
  movement.bounds = Eigen::AlignedBox3d(a_ - Eigen::Vector3d::Constant(1e-3), a_ + Eigen::Vector3d::Constant(1e-3));
  movement.largest_displacement = 0.1e-3;
  list_.followWall(movement);
  EXPECT_TRUE(isValidAt(at));
  list_.followWall(movement);
  EXPECT_FALSE(isValidAt(at));
}

TEST_F(NeighbourListInATube, BecomesInvalidWhenTrianglesMoveForTheFirstTime)
{
  const Eigen::Vector3d at = buildTwice();
  NeighbourList::WallMovement movement;
  movement.bounds = Eigen::AlignedBox3d(a_, b_);
  movement.largest_displacement = 1e-9;
  movement.first = true;
  list_.followWall(movement);
  EXPECT_FALSE(isValidAt(at));
}

TEST_F(NeighbourListInATube, IgnoresMovementsFarAway)
{
  const Eigen::Vector3d at = buildTwice();
  NeighbourList::WallMovement movement;
  movement.bounds = Eigen::AlignedBox3d(Eigen::Vector3d(3e-3, 0.0, 20e-3), Eigen::Vector3d(4e-3, 0.0, 25e-3));
  movement.largest_displacement = 1e-3;
  movement.first = true;
  list_.followWall(movement);
  EXPECT_TRUE(isValidAt(at));
}

}  // namespace
}  // namespace endovascular_sim::contact
