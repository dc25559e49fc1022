#include "vessel/centreline/centreline_extraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <Eigen/Geometry>

#include "geometry/mesh_distance.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/anatomy/tube.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::vessel
{
namespace
{

double distanceToTree(const CentrelineTree& tree, const Eigen::Vector3d& p)
{
  double nearest = 1e300;
  for (const CentrelineBranch& branch : tree.branches)
    for (std::size_t k = 1; k < branch.points.size(); ++k)
    {
      const Eigen::Vector3d chord = branch.points[k] - branch.points[k - 1];
      const double t = std::clamp((p - branch.points[k - 1]).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (branch.points[k - 1] + t * chord - p).norm());
    }
  return nearest;
}

struct Channel
{
  const char* name;
  int facets_around;
  double facet_length;
  std::vector<TubePiece> pieces;
};

void PrintTo(const Channel& channel, std::ostream* out)
{
  *out << channel.name;
}

class CentrelineOfTube : public testing::TestWithParam<Channel>
{
};

TEST_P(CentrelineOfTube, EqualsTheAxisFromCapToCap)
{
  TubeShape shape;
  shape.radius = 3e-3;
  shape.facets_around = GetParam().facets_around;
  shape.facet_length = GetParam().facet_length;
  shape.pieces = GetParam().pieces;
  const CentrelineTree exact = tubeCentreline(shape);
  const CentrelineTree found = extractCentreline(tubeMesh(shape));
  ASSERT_EQ(found.branches.size(), 1U);
  double length = 0.0;
  for (std::size_t k = 0; k < found.branches[0].points.size(); ++k)
  {
    EXPECT_LT(distanceToTree(exact, found.branches[0].points[k]), 0.04 * shape.radius);
    EXPECT_NEAR(found.branches[0].radii[k] / shape.radius, 1.0, 0.06);
    if (k > 0)
      length += (found.branches[0].points[k] - found.branches[0].points[k - 1]).norm();
  }
  double exact_length = kTubeRunIn * shape.radius;
  for (const TubePiece& piece : shape.pieces)
    exact_length += piece.length;
  EXPECT_NEAR(length, exact_length, 0.5 * shape.radius);
  EXPECT_EQ(centrelineEnds(found).size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(
    CentrelineExtraction, CentrelineOfTube,
    testing::Values(Channel{"straight", 32, 1e-3, {{0.08, 0.0, 0.0}}},
                    Channel{"few_long_facets", 12, 20e-3, {{0.08, 0.0, 0.0}}},
                    Channel{"bends", 32, 1e-3, {{0.04, 0, 0}, {0.047, 33.3, 0.3}, {0.03, 50.0, 2.0}, {0.02, 0, 0}}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(CentrelineExtraction, FindsTheBranchesOfAFork)
{
  const Vessel fork = loadAnatomy(std::string(TEST_DATA_DIR) + "/anatomies/fork.yaml", "");
  const CentrelineTree found = extractCentreline(fork.mesh);
  EXPECT_EQ(found.branches.size(), 3U);
  EXPECT_EQ(centrelineEnds(found).size(), 3U);
  std::vector<double> distances;
  for (const CentrelineBranch& branch : fork.centreline.branches)
    for (std::size_t k = 0; k < branch.points.size(); ++k)
      if (branch.name != "right" || (branch.points[k] - branch.points[0]).norm() > branch.radii[0] * 2.5)
        distances.push_back(distanceToTree(found, branch.points[k]) / branch.radii[k]);
  std::sort(distances.begin(), distances.end());
  EXPECT_LT(distances[distances.size() / 2], 0.1);
  EXPECT_LT(distances[distances.size() * 95 / 100], 0.35);
  // The root is the widest end.
  EXPECT_LT(found.branches[0].points.front().z(), 0.0);
  for (std::size_t b = 1; b < found.branches.size(); ++b)
    EXPECT_LT(found.branches[b].parent, static_cast<int>(b));
}

TEST(CentrelineExtraction, IsReproducibleBitForBit)
{
  const Vessel fork = loadAnatomy(std::string(TEST_DATA_DIR) + "/anatomies/fork.yaml", "");
  const CentrelineTree a = extractCentreline(fork.mesh);
  const CentrelineTree b = extractCentreline(fork.mesh);
  ASSERT_EQ(a.branches.size(), b.branches.size());
  for (std::size_t k = 0; k < a.branches.size(); ++k)
  {
    EXPECT_EQ(a.branches[k].points, b.branches[k].points);
    EXPECT_EQ(a.branches[k].radii, b.branches[k].radii);
  }
}

TEST(CentrelineExtraction, AgreesWithThePublishedCentrelinesOfAnArch)
{
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  const std::string file = folder == nullptr ? "" : std::string(folder) + "/aortic_arch_tree.obj";
  if (file.empty() || !std::filesystem::exists(file))
    GTEST_SKIP() << "ENDOVASCULAR_DATA_DIR is not set to the folder of the segmented vessels";
  const geometry::TriangleMesh mesh = repairMesh(readMesh(file, 1e-3), file).mesh;
  const geometry::MeshDistance wall(mesh);
  const CentrelineTree found = extractCentreline(mesh);
  for (const CentrelineBranch& branch : found.branches)
    for (std::size_t k = 0; k < branch.points.size(); k += 5)
      EXPECT_GT(geometry::windingNumber(mesh, branch.points[k]), 0.5);

  // The published centrelines belong to another version of this geometry: some of their points lie outside of the mesh,
  // others off its centre. Selected points from the aortic root to a carotid and an iliac artery:
  const std::vector<Eigen::Vector3d> way{{-371.756, 10.922, -10.498}, {-384.7, 23.205, -15.747},
                                         {-391.955, 46.664, -33.907}, {-416.223, -0.352, -24.138},
                                         {-430.112, 47.537, -34.466}, {-572.004, 14.836, -12.526}};
  for (const Eigen::Vector3d& p : way)
  {
    const double distance = distanceToTree(found, 1e-3 * p);
    EXPECT_LT(distance, std::max(wall.closest(1e-3 * p).distance, 2e-3)) << p.transpose();
  }
}

}  // namespace
}  // namespace endovascular_sim::vessel
