#include "vessel/anatomy/mesh_centreline.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "common/error.h"
#include "test/vessel/io/vtk_files.h"
#include "vessel/anatomy/tube.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kRadius = 0.015;        // [m]
constexpr double kStart = -4 * kRadius;  // cap of the run-in, along z [m]
constexpr double kEnd = 0.01;            // far cap [m]

geometry::TriangleMesh wideTube()
{
  TubeShape shape;
  shape.radius = kRadius;
  shape.facet_length = 5e-3;
  shape.pieces = {{kEnd, 0.0, 0.0}};
  return tubeMesh(shape);
}

/** Centreline file of a straight vessel along z, displaced in x. */
std::string writeCentreline(double x, double start, double end)
{
  std::string file = testing::TempDir() + "/mesh_centreline.yaml";
  std::ofstream(file) << "name: trunk\nunit: 1\nbranches:\n  - name: trunk\n    points: [[" << x << ", 0, " << start
                      << "], [" << x << ", 0, " << 0.5 * (start + end) << "], [" << x << ", 0, " << end
                      << "]]\n    diameters: [[0, 0.03], [1, 0.03]]\n";
  return file;
}

TEST(MeshCentreline, MayPassTheOpenEndsOfAWideVesselByHalfARadius)
{
  // Seven millimetres beyond each cap are 17 % of the centreline.
  const std::string file = writeCentreline(0.0, kStart - 0.007, kEnd + 0.007);
  const CentrelineTree tree = readMeshCentreline(file, 1.0, Eigen::Isometry3d::Identity(), wideTube());
  ASSERT_EQ(tree.branches.size(), 1U);
  EXPECT_EQ(tree.branches[0].name, "trunk");
}

TEST(MeshCentreline, IsRejectedIfItPassesAnOpenEndByTwoRadii)
{
  const std::string file = writeCentreline(0.0, kStart, kEnd + 2 * kRadius);
  EXPECT_THROW(readMeshCentreline(file, 1.0, Eigen::Isometry3d::Identity(), wideTube()), InputError);
}

TEST(MeshCentreline, IsRejectedBesideTheVesselAlsoIfTheBranchIsShort)
{
  const std::string file = writeCentreline(2 * kRadius, -0.004, 0.004);
  EXPECT_THROW(readMeshCentreline(file, 1.0, Eigen::Isometry3d::Identity(), wideTube()), InputError);
}

TEST(MeshCentreline, OfVmtkIsReadInTheUnitAndTheFrameOfTheMesh)
{
  VtkContent content;
  for (int k = 0; k <= 20; ++k)
    content.points.emplace_back(0.0, 0.0, 1e3 * (kStart + (kEnd - kStart) * k / 20.0));
  content.lines.emplace_back();
  for (int k = 0; k <= 20; ++k)
    content.lines.back().push_back(k);
  const std::string file = testing::TempDir() + "/mesh_centreline.vtp";
  std::ofstream(file, std::ios::binary) << vtkFile(content, VtkStorage::kRawZlib);
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translation() = Eigen::Vector3d(0.1, 0.0, 0.0);
  geometry::TriangleMesh moved = wideTube();
  for (Eigen::Vector3d& v : moved.vertices)
    v = transform * v;
  const CentrelineTree tree = readMeshCentreline(file, 1e-3, transform, moved);
  ASSERT_EQ(tree.branches.size(), 1U);
  EXPECT_LT((tree.branches[0].points.back() - Eigen::Vector3d(0.1, 0.0, kEnd)).norm(), 1e-9);
  EXPECT_NEAR(tree.branches[0].radii[tree.branches[0].radii.size() / 2], kRadius, 1e-3);
}

}  // namespace
}  // namespace endovascular_sim::vessel
