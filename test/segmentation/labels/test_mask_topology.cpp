#include "segmentation/labels/mask_topology.h"

#include <gtest/gtest.h>

#include "segmentation/labels/mask_field.h"
#include "segmentation/surface/lattice_surface.h"
#include "segmentation/surface/lumen_surface.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Block of voxels within an empty grid. */
VoxelMask block(const Eigen::Vector3i& size)
{
  VoxelMask mask(size + Eigen::Vector3i::Constant(6), Eigen::Vector3d::Ones(), Eigen::Vector3d::Zero());
  for (std::size_t n = 0; n < mask.inside.size(); ++n)
  {
    const Eigen::Array3i voxel = mask.voxelOf(n).array() - 3;
    mask.inside[n] = (voxel >= 0).all() && (voxel < size.array()).all() ? 1 : 0;
  }
  return mask;
}

/** Removes or adds voxels between two corners. */
void set(VoxelMask& mask, const Eigen::Vector3i& low, const Eigen::Vector3i& high, std::uint8_t value)
{
  for (std::size_t n = 0; n < mask.inside.size(); ++n)
  {
    const Eigen::Array3i voxel = mask.voxelOf(n).array() - 3;
    if ((voxel >= low.array()).all() && (voxel <= high.array()).all())
      mask.inside[n] = value;
  }
}

/** Pseudo-random mask. */
VoxelMask noise(unsigned seed)
{
  VoxelMask mask = block({9, 9, 9});
  unsigned state = seed * 2654435761U + 1U;
  for (std::uint8_t& value : mask.inside)
  {
    state = state * 1664525U + 1013904223U;
    value = value != 0 && (state >> 24U) < 150U ? 1 : 0;
  }
  return mask;
}

TEST(MaskTopology, CountsHandlesWhereThereAreCavitiesAndIslandsToo)
{
  VoxelMask mask = block({12, 9, 9});
  EXPECT_EQ(handlesOf(mask), 0);
  set(mask, {2, 2, 2}, {3, 3, 3}, 0);  // cavity
  EXPECT_EQ(handlesOf(mask), 0);
  set(mask, {6, 4, 0}, {6, 4, 8}, 0);  // tunnel
  EXPECT_EQ(handlesOf(mask), 1);
  set(mask, {9, 0, 4}, {9, 8, 4}, 0);  // another one
  EXPECT_EQ(handlesOf(mask), 2);
  mask.inside[mask.offset({1, 1, 1})] = 1;  // island
  EXPECT_EQ(handlesOf(mask), 2);
  std::vector<int> component;
  EXPECT_EQ(componentsOf(mask, 1, component).size(), 2U);
  EXPECT_EQ(componentsOf(mask, 0, component).size(), 2U);
}

TEST(MaskTopology, IsThatOfTheSurface)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    VoxelMask mask = noise(seed);
    std::vector<int> component;
    const std::vector<std::size_t> sizes = componentsOf(mask, 1, component);
    const auto largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
    for (std::size_t n = 0; n < mask.inside.size(); ++n)
      mask.inside[n] = component[n] == static_cast<int>(largest) ? 1 : 0;
    componentsOf(mask, 0, component);
    for (std::size_t n = 0; n < mask.inside.size(); ++n)
      if (component[n] > 0)  // cavities
        mask.inside[n] = 1;
    std::vector<float> field(mask.inside.size());
    for (std::size_t n = 0; n < field.size(); ++n)
      field[n] = mask.inside[n] != 0 ? -0.5F : 0.5F;
    int components = 0;
    const geometry::TriangleMesh mesh = latticeSurface(LatticeField(field, mask.size), &components);
    EXPECT_EQ(components, 1);
    EXPECT_EQ(genusOf(mesh), handlesOf(mask)) << "seed " << seed;
    EXPECT_TRUE(vessel::checkMesh(mesh).clean());
  }
}

TEST(MaskTopology, OfAGrownSubsetIsThatOfABall)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    const VoxelMask mask = noise(seed);
    const std::vector<float> depth = distancesFrom(mask, 0);
    const auto deepest = static_cast<std::size_t>(std::max_element(depth.begin(), depth.end()) - depth.begin());
    const VoxelMask ball = grown(mask, {deepest}, depth);
    std::vector<int> component;
    EXPECT_EQ(componentsOf(ball, 1, component).size(), 1U);
    EXPECT_EQ(componentsOf(ball, 0, component).size(), 1U);
    EXPECT_EQ(handlesOf(ball), 0);
    for (std::size_t n = 0; n < mask.inside.size(); ++n)
      EXPECT_LE(ball.inside[n], mask.inside[n]);
    EXPECT_GT(2 * ball.voxels(), mask.voxels());
  }
}

TEST(MaskTopology, LeavesABallAsItIs)
{
  const VoxelMask mask = block({7, 5, 6});
  const VoxelMask ball = grown(mask, {mask.offset({5, 5, 5})}, distancesFrom(mask, 0));
  EXPECT_EQ(ball.inside, mask.inside);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
