#include "test/common/input_error_of.h"
#include "vessel/prepare/prepare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "common/error.h"
#include "geometry/closest_point_on_triangle.h"
#include "geometry/surface_samples.h"
#include "test/vessel/prepare/dirty_meshes.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/prepare/component_bridges.h"
#include "vessel/repair/mesh_check.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::vessel
{
namespace
{

using Eigen::Vector3d;

constexpr double kTolerance = 3e-4;  // [m]

PreparedVessel prepare(const geometry::TriangleMesh& mesh, PrepareOptions options = {})
{
  options.max_distance = kTolerance;
  options.facets_around = 16;
  return prepareVessel(mesh, "test", options);
}

void expectCleanWithinTolerance(const PreparedVessel& prepared)
{
  EXPECT_EQ(checkMesh(prepared.mesh).summary(), "");
  EXPECT_LE(prepared.report.input_to_result.largest, kTolerance) << prepared.report.text(prepared.centreline);
  EXPECT_LE(prepared.report.result_to_input.largest, kTolerance) << prepared.report.text(prepared.centreline);
}

const Cylinder kTrunk{{0, 0, 0}, {0, 0, 0.016}, 3e-3};
const Cylinder kSide{{0, 0, 0.008}, {8e-3, 0, 9e-3}, 1.5e-3};

TEST(Prepare, UnitesOverlappingTubesWithinTheTolerance)
{
  geometry::TriangleMesh soup = kTrunk.mesh(96, 20);
  append(soup, kSide.mesh(64, 20));
  const PreparedVessel prepared = prepare(soup);
  expectCleanWithinTolerance(prepared);
  EXPECT_LE(largestDistance(prepared.mesh, {kTrunk, kSide}), kTolerance);
  EXPECT_EQ(prepared.report.before.defects.components.size(), 2U);
  EXPECT_EQ(prepared.report.after.defects.genus, 0);
  EXPECT_GT(prepared.report.inner_area, 0.0);
}

TEST(Prepare, ReportsTheDistancesOfABruteForceSearch)
{
  const geometry::TriangleMesh input = kSide.mesh(16, 6);
  const PreparedVessel prepared = prepare(input);
  const auto largest = [](const geometry::TriangleMesh& from, const geometry::TriangleMesh& to)
  {
    double distance = 0.0;
    for (const geometry::SurfaceSample& sample : geometry::sampleSurface(from, 2.0 * 2.0 / 3.0 * kTolerance))
    {
      double nearest = 1e300;
      for (const Eigen::Vector3i& t : to.triangles)
        nearest = std::min(nearest,
                           (geometry::closestPointOnTriangle(sample.point, to.vertices[static_cast<std::size_t>(t[0])],
                                                             to.vertices[static_cast<std::size_t>(t[1])],
                                                             to.vertices[static_cast<std::size_t>(t[2])])
                                .point -
                            sample.point)
                               .norm());
      distance = std::max(distance, nearest);
    }
    return distance;
  };
  EXPECT_NEAR(prepared.report.input_to_result.largest, largest(input, prepared.mesh), 1e-12);
  EXPECT_NEAR(prepared.report.result_to_input.largest, largest(prepared.mesh, input), 1e-12);
  EXPECT_GT(prepared.report.input_to_result.largest, 2e-5);
}

TEST(Prepare, IsIndependentOfTheOrientationOfComponents)
{
  geometry::TriangleMesh soup = kTrunk.mesh(96, 20);
  geometry::TriangleMesh side = kSide.mesh(64, 20);
  for (Eigen::Vector3i& t : side.triangles)
    std::swap(t[1], t[2]);
  append(soup, side);
  for (std::size_t t = 0; t < soup.triangles.size(); t += 7)
    std::swap(soup.triangles[t][0], soup.triangles[t][1]);
  const PreparedVessel prepared = prepare(soup);
  expectCleanWithinTolerance(prepared);
  EXPECT_LE(largestDistance(prepared.mesh, {kTrunk, kSide}), kTolerance);
}

TEST(Prepare, ClosesAHoleByALid)
{
  geometry::TriangleMesh mesh = kTrunk.mesh(96, 50);
  const Vector3d hole(3e-3, 0, 8e-3);
  geometry::TriangleMesh holed = mesh;
  holed.triangles.clear();
  for (const Eigen::Vector3i& t : mesh.triangles)
    if ((centreOf(mesh, t) - hole).norm() > 1.2e-3)
      holed.triangles.push_back(t);
  ASSERT_LT(holed.triangles.size(), mesh.triangles.size());
  const PreparedVessel prepared = prepare(holed);
  expectCleanWithinTolerance(prepared);
  ASSERT_EQ(prepared.report.holes.size(), 1U);
  EXPECT_LT((prepared.report.holes[0].location - hole).norm(), 5e-4);
  // The lid is planar: its largest depth is the sagitta of a 1.2 mm chord at a radius of 3 mm.
  EXPECT_LE(largestDistance(prepared.mesh, {kTrunk}), kTolerance + 1.3e-3 * 1.3e-3 / (2 * 3e-3));
  EXPECT_GT(prepared.report.lid_area, 1e-6);
}

TEST(Prepare, DropsFinsDuplicatesAndSlivers)
{
  geometry::TriangleMesh mesh = kTrunk.mesh(96, 20);
  const auto add = [&mesh](const Vector3d& p)
  {
    mesh.vertices.push_back(p);
    return static_cast<int>(mesh.vertices.size()) - 1;
  };
  const Eigen::Vector3i at_fin = mesh.triangles[300];
  mesh.triangles.emplace_back(at_fin[0], at_fin[1], add(centreOf(mesh, at_fin) * 0.98));
  mesh.triangles.push_back(mesh.triangles[400]);
  const Eigen::Vector3i cut = mesh.triangles[500];
  const Vector3d a = mesh.vertices[static_cast<std::size_t>(cut[0])];
  const Vector3d b = mesh.vertices[static_cast<std::size_t>(cut[1])];
  const int on_edge = add(a + 0.5 * (b - a) + Vector3d(0, 0, 1e-9));
  mesh.triangles.emplace_back(cut[0], on_edge, cut[1]);  // sliver with a non-manifold edge
  EXPECT_GT(checkMesh(mesh).non_manifold_edges.count, 0);
  EXPECT_GT(checkMesh(mesh).duplicate_faces.count, 0);
  const PreparedVessel prepared = prepare(mesh);
  EXPECT_EQ(checkMesh(prepared.mesh).summary(), "");
  EXPECT_LE(largestDistance(prepared.mesh, {kTrunk}), kTolerance);
}

/** Two parallel tubes, connected by a crossbar. */
std::vector<Cylinder> fork(double septum)
{
  const double x = 2e-3 + 0.5 * septum;
  return {{{-x, 0, 0}, {-x, 0, 0.01}, 2e-3}, {{x, 0, 0}, {x, 0, 0.01}, 2e-3}, {{-x, 0, 0.01}, {x, 0, 0.01}, 2e-3}};
}

geometry::TriangleMesh soupOf(const std::vector<Cylinder>& parts)
{
  geometry::TriangleMesh soup;
  for (const Cylinder& part : parts)
    append(soup, part.mesh(64, 20));
  return soup;
}

TEST(Prepare, RetainsASeptumOfThreeVoxels)
{
  const std::vector<Cylinder> parts = fork(6e-4);
  const PreparedVessel prepared = prepare(soupOf(parts));
  expectCleanWithinTolerance(prepared);
  EXPECT_LE(largestDistance(prepared.mesh, parts), kTolerance);
  EXPECT_EQ(prepared.report.after.defects.genus, 0);
}

TEST(Prepare, ReportsASeptumLostByTheGrid)
{
  PrepareOptions options;
  options.voxel = 6e-4;
  const PreparedVessel prepared = prepare(soupOf(fork(2.5e-4)), options);
  EXPECT_GT(prepared.report.gaps.closed, 0);
  EXPECT_GE(prepared.report.gaps.widest_closed, 2.4e-4);
  EXPECT_NE(prepared.report.text(prepared.centreline).find("a septum there requires --voxel"), std::string::npos);
}

TEST(Prepare, ReportsLooseComponentsAndBridgesThemOnRequest)
{
  const Cylinder above{{0, 0, 0.017}, {0, 0, 0.024}, 2e-3};
  geometry::TriangleMesh soup = kTrunk.mesh(64, 20);
  append(soup, above.mesh(64, 20));
  PrepareOptions options;
  options.voxel = 3e-4;
  const PreparedVessel loose = prepare(soup, options);
  ASSERT_EQ(loose.report.dropped.size(), 1U);
  EXPECT_NEAR(loose.report.dropped[0].gap, 1e-3, 4e-4);
  EXPECT_NEAR(loose.report.dropped[0].volume, M_PI * 4e-6 * 0.007, 0.02 * M_PI * 4e-6 * 0.007);

  options.bridge = 1.5e-3;
  const PreparedVessel joined = prepare(soup, options);
  EXPECT_EQ(checkMesh(joined.mesh).summary(), "");
  EXPECT_TRUE(joined.report.dropped.empty());
  ASSERT_EQ(joined.report.bridges.size(), 1U);
  const double both = M_PI * (9e-6 * 0.016 + 4e-6 * 0.007);
  EXPECT_GT(joined.mesh.signedVolume(), 0.97 * both);
  EXPECT_LT(joined.mesh.signedVolume(), both + M_PI * 4e-6 * 1.2e-3);
}

constexpr double kBore = 1.8e-3;

/** Trunk with a bore of 1.8 mm radius: outer and inner wall, connected by annular ends. */
geometry::TriangleMesh pipe()
{
  geometry::TriangleMesh outer = kTrunk.mesh(48, 12);
  geometry::TriangleMesh inner = Cylinder{kTrunk.from, kTrunk.to, kBore}.mesh(48, 12);
  for (geometry::TriangleMesh* mesh : {&outer, &inner})
    mesh->triangles.erase(std::remove_if(mesh->triangles.begin(), mesh->triangles.end(),
                                         [](const Eigen::Vector3i& t) { return t.minCoeff() < 2; }),
                          mesh->triangles.end());
  const int offset = static_cast<int>(outer.vertices.size());
  append(outer, inner);
  for (int row : {0, 12})
    for (int k = 0; k < 48; ++k)
    {
      const int a = 2 + row * 48 + k;
      const int b = 2 + row * 48 + (k + 1) % 48;
      outer.triangles.emplace_back(a, b, offset + b);
      outer.triangles.emplace_back(a, offset + b, offset + a);
    }
  return outer;
}

const std::vector<Plug> kPipePlugs{{{1e-4, 0, 5e-4}, 2.4e-3}, {{0, 1e-4, 0.0155}, 2.4e-3}};
const double kPipeVolume = M_PI * 9e-6 * 0.016;
const double kBoreVolume = M_PI * kBore * kBore * 0.016;

TEST(Prepare, FillsAThickWallWithPluggedOpenings)
{
  PrepareOptions options;
  options.plugs = kPipePlugs;
  const PreparedVessel prepared = prepare(pipe(), options);
  EXPECT_NEAR(prepared.mesh.signedVolume(), kPipeVolume, 0.05 * kPipeVolume);
  EXPECT_EQ(checkMesh(prepared.mesh).summary(), "");
  EXPECT_NEAR(prepared.report.inner_area, 2.0 * M_PI * kBore * 0.015, 0.05 * 2.0 * M_PI * kBore * 0.016);
}

TEST(Prepare, ExtractsTheLumenInsideAThickWall)
{
  PrepareOptions options;
  options.plugs = kPipePlugs;
  options.hollow = true;
  options.open = {"all"};
  const PreparedVessel prepared = prepare(pipe(), options);
  EXPECT_NEAR(repairMesh(prepared.mesh, "bore").mesh.signedVolume(), kBoreVolume * (1.0 - 2.0 * 2.4 / 16.0),
              0.08 * kBoreVolume);
  EXPECT_LE(prepared.report.result_to_input.largest, kTolerance) << prepared.report.text(prepared.centreline);
  EXPECT_GT(prepared.report.lid_area, M_PI * kBore * kBore);
  ASSERT_EQ(prepared.report.openings.size(), 2U);
  for (const Opening& opening : prepared.report.openings)
  {
    EXPECT_NEAR(opening.radius, kBore, kTolerance);
    EXPECT_GT(std::abs(opening.outward.z()), 0.99);
  }
}

TEST(Prepare, RejectsAnOpenCavityAndAPlugWithoutWalls)
{
  PrepareOptions options;
  options.hollow = true;
  for (const std::vector<Plug>& plugs : {std::vector<Plug>{}, {kPipePlugs[0]}})
  {
    options.plugs = plugs;
    const std::string message = inputErrorOf([&] { prepare(pipe(), options); });
    EXPECT_NE(message.find("close every opening with a --plug"), std::string::npos) << message;
  }
  options.plugs = {{{0, 0, 0.008}, 1.5e-3}};
  EXPECT_THROW(prepare(pipe(), options), InputError);
}

TEST(Prepare, OpensSelectedEndsWithPlanarRimsThatASceneCloses)
{
  geometry::TriangleMesh soup = kTrunk.mesh(96, 20);
  append(soup, kSide.mesh(64, 20));
  PrepareOptions options;
  options.open = {"2", "0.008,0,0.009"};
  const PreparedVessel prepared = prepare(soup, options);
  ASSERT_EQ(prepared.report.openings.size(), 3U);
  EXPECT_EQ(prepared.report.rims, 3);
  MeshReport report = checkMesh(prepared.mesh);
  EXPECT_GT(report.boundary_edges.count, 30);
  report.boundary_edges = {};
  EXPECT_EQ(report.summary(), "");

  const RepairedMesh closed = repairMesh(prepared.mesh, "opened");
  EXPECT_EQ(checkMesh(closed.mesh).summary(), "");
  ASSERT_FALSE(closed.notes.empty());
  EXPECT_NE(closed.notes[0].find("3 planar ends"), std::string::npos) << closed.notes[0];
  for (const Opening& opening : prepared.report.openings)
    EXPECT_LT(std::min(std::abs(opening.radius - 3e-3), std::abs(opening.radius - 1.5e-3)), kTolerance);
}

TEST(Prepare, RejectsAnUnknownEndAndListsTheKnownOnes)
{
  PrepareOptions options;
  options.open = {"aorta"};
  const std::string text = inputErrorOf([&] { prepare(kTrunk.mesh(48, 10), options); });
  EXPECT_NE(text.find("--open aorta"), std::string::npos) << text;
  EXPECT_NE(text.find("branch_0 near ("), std::string::npos) << text;
}

TEST(Prepare, RejectsAnOpenSurfaceAndInvalidOptions)
{
  geometry::TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}};
  flat.triangles = {{0, 1, 2}};
  EXPECT_THROW(prepare(flat), InputError);
  PrepareOptions options;
  options.voxel = 1e-7;
  EXPECT_THROW(prepare(kTrunk.mesh(48, 10), options), InputError);
  options = {};
  options.cut_back = -1;
  EXPECT_THROW(prepare(kTrunk.mesh(48, 10), options), InputError);
}

/** Root mean square of the dihedral angles, without the caps [rad]. */
double roughness(const geometry::TriangleMesh& mesh)
{
  double sum = 0.0;
  int count = 0;
  std::map<std::pair<int, int>, Vector3d> first;
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const double z = centreOf(mesh, t).z();
    if (z < 4e-3 || z > 0.012)
      continue;
    const Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (int k = 0; k < 3; ++k)
    {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      const auto [entry, is_new] = first.try_emplace({std::min(a, b), std::max(a, b)}, normal);
      if (is_new)
        continue;
      const double turn = std::acos(std::min(1.0, normal.dot(entry->second)));
      sum += turn * turn;
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

TEST(Prepare, SmoothsACoarseTubeWithinTheTolerance)
{
  // Ten facets: their centres lie 0.15 mm inside the cylinder.
  const geometry::TriangleMesh coarse = kTrunk.mesh(10, 4);
  const PreparedVessel as_is = prepare(coarse);
  PrepareOptions options;
  options.smooth = true;
  const PreparedVessel smooth = prepare(coarse, options);
  expectCleanWithinTolerance(smooth);
  EXPECT_LT(roughness(smooth.mesh), 0.9 * roughness(as_is.mesh));
  // Smoothing moves the wall from the prism towards the circumscribed cylinder, but not beyond it.
  EXPECT_GT(smooth.mesh.signedVolume(), 0.99 * as_is.mesh.signedVolume());
  EXPECT_LT(smooth.mesh.signedVolume(), M_PI * 9e-6 * 0.016);
  EXPECT_GT(smooth.report.largest_move, 1e-5);
  EXPECT_LE(smooth.report.largest_move, 0.5 * kTolerance + 1e-12);
}

TEST(Prepare, ExtractsTheCentrelineWithRadii)
{
  const PreparedVessel prepared = prepare(kTrunk.mesh(96, 20));
  ASSERT_EQ(prepared.centreline.branches.size(), 1U);
  int looked_at = 0;
  for (std::size_t k = 0; k < prepared.report.radii.size(); ++k)
  {
    const Vector3d& p = prepared.centreline.branches[0].points[k];
    if (p.z() < 4e-3 || p.z() > 0.012)
      continue;
    ++looked_at;
    EXPECT_LT(std::hypot(p.x(), p.y()), kTolerance);
    EXPECT_NEAR(prepared.report.radii[k].after, 3e-3, kTolerance);
    EXPECT_NEAR(prepared.report.radii[k].before, 3e-3, kTolerance);
  }
  EXPECT_GT(looked_at, 2);
}

TEST(Prepare, IsReproducibleBitForBit)
{
  geometry::TriangleMesh soup = kTrunk.mesh(48, 10);
  append(soup, kSide.mesh(32, 10));
  EXPECT_EQ(prepare(soup).mesh.hash(), prepare(soup).mesh.hash());
}

/** Meshes of segmented vessels, which are not part of the repository. Large voxels reduce the run time. */
class DirtyVessels : public testing::Test
{
protected:
  void SetUp() override
  {
    const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
    if (folder == nullptr || !std::filesystem::exists(std::string(folder) + "/aortic_arch_tree.obj"))
      GTEST_SKIP() << "ENDOVASCULAR_DATA_DIR is not set to the folder of the segmented vessels";
    folder_ = std::string(folder) + "/";
    options_.max_distance = 1.2e-3;
    options_.longest_facet = 4e-3;
    options_.facets_around = 16;
  }
  std::string folder_;
  PrepareOptions options_;
};

TEST_F(DirtyVessels, PreparesThePhantomAsOneClosedSurface)
{
  const geometry::TriangleMesh mesh = readMesh(folder_ + "abdominal_aorta_phantom.stl", 1.0);
  options_.max_distance = 1e-3;
  options_.hollow = true;
  options_.plugs = {{{0.0008, -0.083, 0.004}, 0.017},  {{-0.052, 0.134, 0.004}, 0.0095},
                    {{0.053, 0.130, 0.004}, 0.0095},   {{-0.051, -0.0336, 0.0012}, 0.005},
                    {{0.0748, -0.0105, 0.006}, 0.005}, {{0.036, -0.020, -0.042}, 0.006}};
  const PreparedVessel prepared = prepareVessel(mesh, "phantom", options_);
  EXPECT_EQ(checkMesh(prepared.mesh).summary(), "");
  EXPECT_EQ(prepared.report.before.defects.boundary_edges.count, 18);
  EXPECT_EQ(prepared.report.after.defects.genus, 0);
  EXPECT_NEAR(prepared.mesh.signedVolume(), 89.9e-6, 1e-6);
  EXPECT_EQ(centrelineEnds(prepared.centreline).size(), 5U);
  EXPECT_LT(prepared.report.input_to_result.p99, options_.max_distance);
}

double distanceToEnd(const CentrelineTree& tree, const Vector3d& point)
{
  double nearest = 1e300;
  for (const CentrelineEnd& end : centrelineEnds(tree))
    nearest = std::min(nearest, (end.position - point).norm());
  return nearest;
}

/** Commands of docs/VESSELS.md with a coarser grid. */
TEST_F(DirtyVessels, ConnectsTheFemoralArteriesWithTheCoronaries)
{
  geometry::TriangleMesh mesh = readMesh(folder_ + "aorta_coronary_female.obj", 1e-3);
  append(mesh, loadAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/aorta_coronary_female_iliacs.yaml", "").mesh);
  options_.bridge = 6e-3;
  options_.plugs = {
      {{0.0287, 0.5445, -0.0157}, 8e-3},   {{0.0233, 0.5514, -0.0150}, 5e-3},   {{-0.0270, 0.5320, -0.0024}, 5e-3},
      {{-0.0330, 0.5670, 0.0086}, 3e-3},   {{0.0185, 0.5660, 0.0200}, 4e-3},    {{0.0744, 0.2145, -0.0262}, 2.5e-3},
      {{0.0706, 0.2222, -0.0309}, 2.5e-3}, {{0.0600, 0.2332, -0.0362}, 2.5e-3}, {{0.0636, 0.2526, -0.0499}, 2.5e-3}};
  const PreparedVessel prepared = prepareVessel(mesh, "aorta", options_);
  EXPECT_EQ(checkMesh(prepared.mesh).summary(), "");
  EXPECT_EQ(prepared.report.bridges.size(), 2U);
  EXPECT_TRUE(prepared.report.dropped.empty()) << prepared.report.text(prepared.centreline);
  EXPECT_LT(prepared.report.input_to_result.p99, options_.max_distance);
  // Both femoral arteries, left anterior descending and diagonal artery. The grid is too coarse for the narrowest part
  // of the right coronary artery.
  for (const Vector3d& end : {Vector3d(0.091, -0.060, 0.021), Vector3d(-0.074, -0.060, 0.023),
                              Vector3d(0.103, 0.381, 0.036), Vector3d(0.108, 0.427, -0.017)})
    EXPECT_LT(distanceToEnd(prepared.centreline, end), 0.010) << end.transpose();
}

}  // namespace
}  // namespace endovascular_sim::vessel
