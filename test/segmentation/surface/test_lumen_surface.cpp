#include "segmentation/surface/lumen_surface.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Straight tube. */
LumenBranch tube(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius)
{
  LumenBranch branch;
  const Eigen::Vector3d tangent = (to - from).normalized();
  const int n = static_cast<int>((to - from).norm() / 5e-4) + 1;
  for (int k = 0; k <= n; ++k)
  {
    Section section;
    section.centre = from + static_cast<double>(k) / n * (to - from);
    section.tangent = tangent;
    section.u = tangent.cross(Eigen::Vector3d(0.3, 0.5, 0.8)).normalized();
    section.w = tangent.cross(section.u);
    section.radii.fill(radius);
    branch.sections.push_back(section);
  }
  return branch;
}

TEST(LumenSurface, OfAStraightTubeIsACylinderWithFlatEnds)
{
  const geometry::TriangleMesh mesh = lumenSurface({tube({0.001, 0.0, 0.0}, {0.001, 0.003, 0.02}, 0.002)}, {});
  EXPECT_TRUE(vessel::checkMesh(mesh).clean());
  EXPECT_EQ(genusOf(mesh), 0);
  const double volume = M_PI * 4e-6 * std::hypot(0.003, 0.02);
  EXPECT_NEAR(mesh.signedVolume(), volume, 0.01 * volume);
}

TEST(LumenSurface, OfAForkHasGenusZeroAlsoWhereTheBranchesTouchBeforeTheyJoin)
{
  // Two branches that touch along 6 mm with a narrow gap, and join at their begin.
  LumenBranch left = tube({0.0, 0.0, 0.0}, {0.0, 0.0, 0.012}, 0.0015);
  LumenBranch right = left;
  for (std::size_t k = 0; k < right.sections.size(); ++k)
  {
    const double s = static_cast<double>(k) / static_cast<double>(right.sections.size() - 1);
    const double apart =
        s < 0.3 ? 0.0031 * s / 0.3
                : 0.0031 - 2e-4 * std::sin(20.0 * s) * (s < 0.8 ? 1.0 : 0.0) + std::max(0.0, s - 0.8) * 0.02;
    right.sections[k].centre.x() += apart;
  }
  SurfaceSettings settings;
  settings.blend = 0.0;
  const int without = genusOf(lumenSurface({left, right}, settings));
  settings.blend = 1.6;
  const geometry::TriangleMesh mesh = lumenSurface({left, right}, settings);
  EXPECT_GT(without, 0);
  EXPECT_EQ(genusOf(mesh), 0);
  EXPECT_TRUE(vessel::checkMesh(mesh).clean());
}

TEST(LumenSurface, KeepsTheWallThatTwoTubesShare)
{
  const LumenBranch tube_a = tube({0.0, 0.0, 0.0}, {0.0, 0.0, 0.02}, 0.002);
  const LumenBranch tube_b = tube({0.0, 0.0, 0.005}, {0.0, 0.0, 0.02}, 0.002);
  const double alone = lumenSurface({tube_a}, {}).signedVolume();
  EXPECT_NEAR(lumenSurface({tube_a, tube_b}, {}).signedVolume(), alone, 1e-3 * alone);
}

TEST(LumenSurface, HasTheSameBitsWithAnyNumberOfThreads)
{
  const std::vector<LumenBranch> branches = {tube({0.0, 0.0, 0.0}, {0.0, 0.0, 0.02}, 0.002),
                                             tube({0.0, 0.0, 0.01}, {0.01, 0.0, 0.012}, 0.001)};
  SurfaceSettings settings;
  settings.threads = 1;
  const std::uint64_t one = lumenSurface(branches, settings).hash();
  settings.threads = 4;
  EXPECT_EQ(lumenSurface(branches, settings).hash(), one);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
