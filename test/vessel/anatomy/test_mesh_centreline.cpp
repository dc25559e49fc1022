#include "vessel/anatomy/mesh_centreline.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "common/error.h"
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
  const CentrelineTree tree = readMeshCentreline(file, Eigen::Isometry3d::Identity(), wideTube());
  ASSERT_EQ(tree.branches.size(), 1U);
  EXPECT_EQ(tree.branches[0].name, "trunk");
}

TEST(MeshCentreline, IsRejectedIfItPassesAnOpenEndByTwoRadii)
{
  const std::string file = writeCentreline(0.0, kStart, kEnd + 2 * kRadius);
  EXPECT_THROW(readMeshCentreline(file, Eigen::Isometry3d::Identity(), wideTube()), InputError);
}

TEST(MeshCentreline, IsRejectedBesideTheVesselAlsoIfTheBranchIsShort)
{
  const std::string file = writeCentreline(2 * kRadius, -0.004, 0.004);
  EXPECT_THROW(readMeshCentreline(file, Eigen::Isometry3d::Identity(), wideTube()), InputError);
}

}  // namespace
}  // namespace endovascular_sim::vessel
