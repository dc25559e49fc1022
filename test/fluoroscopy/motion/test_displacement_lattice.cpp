#include "fluoroscopy/motion/displacement_lattice.h"

#include <gtest/gtest.h>

#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

TEST(DisplacementLattice, InterpolatesDisplacementsWithinAThirdOfAVoxel)
{
  const BodyMotion motion = largestMotion();
  DisplacementLattice lattice(motion.box(), 6e-3);
  lattice.fill(motion, Eigen::Matrix3d::Identity());
  double largest = 0.0, displacement = 0.0;
  for (const Eigen::Vector3d& point : motion::pointsAround(motion.map().frame(), 20))
  {
    const Eigen::Vector3d exact = motion.pullBack(point) - point;
    if (!motion.box().contains(point))
      continue;
    largest = std::max(largest, (lattice.at(point).cast<double>() - exact).norm());
    displacement = std::max(displacement, exact.norm());
  }
  EXPECT_GT(displacement, 8e-3);
  EXPECT_LT(largest, 0.4e-3);
}

TEST(DisplacementLattice, IsExactAtItsNodesAndZeroOutside)
{
  const BodyMotion motion = largestMotion();
  DisplacementLattice lattice(motion.box(), 8e-3);
  lattice.fill(motion, 1e3 * Eigen::Matrix3d::Identity());
  const Eigen::Vector3d node = motion.box().min() + 8e-3 * Eigen::Vector3d(16, 11, 17);
  const Eigen::Vector3d exact = 1e3 * (motion.pullBack(node) - node);
  EXPECT_GT(exact.norm(), 1.0);
  EXPECT_LT((lattice.at(node).cast<double>() - exact).norm(), 1e-4);
  EXPECT_EQ(lattice.at(motion.box().min() - Eigen::Vector3d::Constant(1e-3)), Eigen::Vector3f::Zero());
  EXPECT_EQ(lattice.at(motion.box().max() + Eigen::Vector3d::Constant(0.1)), Eigen::Vector3f::Zero());
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
