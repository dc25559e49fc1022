#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "geometry/mesh_distance.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kTolerance = 25e-6;  // m: of the tessellation

WallLaw smoothLaw()
{
  WallLaw law;
  law.shape = WallShape::kSmooth;
  return law;
}

/** Signed distance to a closed, fine mesh by brute force. */
double bruteSigned(const geometry::TriangleMesh& mesh, const geometry::MeshDistance& distance, const Eigen::Vector3d& p)
{
  const double d = distance.closest(p).distance;
  return geometry::windingNumber(mesh, p) > 0.5 ? d : -d;
}

geometry::TriangleMesh coarseTube()
{
  return bumpy(geometry::midpointSubdivision(bentTube(), 1), 0.05);
}

TEST(SmoothDetector, FindsTheWallWithinTheMarginOfEveryNode)
{
  const geometry::TriangleMesh mesh = coarseTube();
  Detector detector(mesh, smoothLaw());
  const geometry::TriangleMesh fine = tessellate(*detector.model()->smooth(), 6);
  const geometry::MeshDistance distance(fine);
  std::mt19937 random(11);
  ContactSet set;
  int touched = 0;
  for (int trial = 0; trial < 12; ++trial)
  {
    const Query query = randomWire(Eigen::Vector3d(0.0, 0.0, 0.01 + 1e-3 * trial), random, 12);
    detector.detect(query, set);
    for (std::size_t i = 0; i < query.nodes.size(); ++i)
    {
      const double gap = bruteSigned(fine, distance, query.nodes[i]) - query.radius[i];
      double found = std::numeric_limits<double>::infinity();
      for (const Feature& feature : set.features)
        if (feature.edge + feature.parameter == query.first_node + static_cast<double>(i))
          found = std::min(found, feature.gap);
      if (std::abs(gap + query.radius[i]) < query.radius[i] + query.margin[i] - kTolerance)
      {
        ++touched;
        EXPECT_NEAR(found, gap, kTolerance);
      }
      else if (std::isfinite(found))
      {
        EXPECT_NEAR(found, gap, kTolerance);
      }
    }
  }
  EXPECT_GT(touched, 5);
}

TEST(SmoothDetector, FindsTheMinimumBetweenTheNodesOverABulge)
{
  // The inner side of the bend is convex towards the lumen along the tube.
  const geometry::TriangleMesh mesh = bentTube();
  Detector detector(mesh, smoothLaw());
  const geometry::TriangleMesh fine = tessellate(*detector.model()->smooth(), 6);
  const geometry::MeshDistance distance(fine);
  const Eigen::Vector3d inwards(std::cos(0.3), std::sin(0.3), 0.0);  // towards the centre of the bend
  const Eigen::Vector3d centre = Eigen::Vector3d(0.0, 0.0, 0.03) + 0.02 * inwards;
  Query query;
  query.margin.assign(2, 0.5e-3);
  query.radius.assign(2, 0.4e-3);
  const auto at = [&](double angle)
  {
    const double r = 0.02 - 3.5e-3;
    return Eigen::Vector3d(centre + r * (-std::cos(angle) * inwards + std::sin(angle) * Eigen::Vector3d::UnitZ()));
  };
  query.nodes = {at(0.8), at(0.95)};
  ContactSet set;
  detector.detect(query, set);
  double found = std::numeric_limits<double>::infinity();
  for (const Feature& feature : set.features)
    if (feature.parameter > 0.0 && feature.parameter < 1.0)
      found = std::min(found, feature.gap);
  double brute = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= 200; ++k)
    brute = std::min(brute, distance.closest(query.nodes[0] + k / 200.0 * (query.nodes[1] - query.nodes[0])).distance);
  EXPECT_NEAR(found, brute - 0.4e-3, kTolerance);
}

/** An edge of a wire that crosses a random reflex edge of a wall, up to 0.6 mm away from it. */
Query crossingWire(const Wall& wall, std::mt19937& random)
{
  std::uniform_int_distribution<std::size_t> any(0, wall.edges.size() - 1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::size_t e = any(random);
  while (wall.edges[e].reflex_angle < 0.1)
    e = any(random);
  const WallEdge& edge = wall.edges[e];
  const Eigen::Vector3d middle = 0.5 * (wall.vertices[edge.vertices[0]] + wall.vertices[edge.vertices[1]]);
  const Eigen::Vector3d t1 = edge.normal.unitOrthogonal();
  const double angle = 2.0 * M_PI * share(random);
  const Eigen::Vector3d along = std::cos(angle) * t1 + std::sin(angle) * edge.normal.cross(t1);
  const Eigen::Vector3d over = middle + 0.6e-3 * share(random) * edge.normal;
  Query query;
  query.radius.assign(2, 0.4e-3);
  query.margin.assign(2, 0.25e-3);
  query.nodes = {over - 1.8e-3 * share(random) * along, over};
  query.nodes[1] = query.nodes[0] + 1.8e-3 * along;
  return query;
}

/** A smooth wall is nowhere farther from its facets than its deviation, so that beyond it both have the same sides. */
void expectSidesOfFacets(const geometry::TriangleMesh& mesh, int points)
{
  const Detector facets(mesh, WallLaw());
  const Detector smooth(mesh, smoothLaw());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> offset(-3e-3, 3e-3);
  int compared = 0;
  for (int trial = 0; trial < points; ++trial)
  {
    const Eigen::Vector3i& corners = mesh.triangles[random() % mesh.triangles.size()];
    Eigen::Vector3d point = (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]) / 3.0;
    for (int k = 0; k < 3; ++k)
      point[k] += offset(random);
    const double distance = facets.signedDistance(point);
    if (std::abs(distance) <= smooth.model()->deviation())
      continue;
    ++compared;
    ASSERT_GT(smooth.signedDistance(point) * distance, 0.0) << "at " << point.transpose() << ", " << distance;
  }
  EXPECT_GT(compared, points / 2);
}

TEST(SmoothDetector, HasTheSidesOfItsFacetsBeyondItsDeviation)
{
  for (const double bumps : {0.05, 0.15, 0.3})
    expectSidesOfFacets(bumpy(geometry::midpointSubdivision(bentTube(), 1), bumps), 20000);
}

TEST(SmoothDetector, HasTheSidesOfItsFacetsInARealAorta)
{
  const std::string file = dataFile("aortic_arch_tree.obj");
  if (file.empty())
    GTEST_SKIP() << "set ENDOVASCULAR_DATA_DIR to the folder of aortic_arch_tree.obj";
  expectSidesOfFacets(refinedForSmoothWall(realMesh(file)), 100000);
}

TEST(SmoothDetector, FindsTheWallAlongEveryEdgeOfTheWireInACreasedMesh)
{
  const geometry::TriangleMesh mesh = bumpy(geometry::midpointSubdivision(bentTube(), 1), 0.15);
  Detector detector(mesh, smoothLaw());
  EXPECT_GT(detector.model()->smooth()->creaseShare(), 0.1);
  const geometry::MeshDistance distance(tessellate(*detector.model()->smooth(), 6));
  std::mt19937 random(17);
  ContactSet set;
  int between = 0;
  double worst = 0.0;
  for (int trial = 0; trial < 400; ++trial)
  {
    const Query query = crossingWire(detector.wall(), random);
    detector.detect(query, set);
    double least = std::numeric_limits<double>::infinity();
    bool inside = true;
    int least_at = 0;
    for (int k = 0; k <= 30; ++k)
    {
      const Eigen::Vector3d p = query.nodes[0] + k / 30.0 * (query.nodes[1] - query.nodes[0]);
      const double gap = distance.closest(p).distance - query.radius[0];
      inside = inside && detector.signedDistance(p) > 0.0;
      least_at = gap < least ? k : least_at;
      least = std::min(least, gap);
    }
    if (!inside || least > query.margin[0])
      continue;
    between += least_at > 0 && least_at < 30;
    double found = query.margin[0];
    for (const Feature& feature : set.features)
      found = std::min(found, feature.gap);
    worst = std::max(worst, found - least);
  }
  EXPECT_GT(between, 50);
  EXPECT_LT(worst, kTolerance);
}

TEST(SmoothDetector, FreeDistancesReachNoPointOfTheWall)
{
  const geometry::TriangleMesh mesh = coarseTube();
  Detector detector(mesh, smoothLaw());
  const geometry::TriangleMesh fine = tessellate(*detector.model()->smooth(), 6);
  const geometry::MeshDistance distance(fine);
  std::mt19937 random(12);
  ContactSet set;
  for (int trial = 0; trial < 10; ++trial)
  {
    const Query query = randomWire(Eigen::Vector3d(0.0, 0.0, 0.01), random, 10);
    detector.freeDistances(query, 2e-3, set);
    for (std::size_t i = 0; i + 1 < query.nodes.size(); ++i)
    {
      double least = std::numeric_limits<double>::infinity();
      for (int k = 0; k <= 20; ++k)
        least = std::min(least,
                         distance.closest(query.nodes[i] + k / 20.0 * (query.nodes[i + 1] - query.nodes[i])).distance);
      if (set.free_distance[i] > query.margin[i])
      {
        EXPECT_LE(set.free_distance[i], least - query.radius[i] + kTolerance);
      }
    }
  }
}

TEST(SmoothDetector, GivesTheBitsOfANewDetector)
{
  const geometry::TriangleMesh mesh = coarseTube();
  const std::shared_ptr<const WallModel> model = WallModel::create(mesh, WallShape::kSmooth);
  Detector used(model, WallLaw{});
  std::mt19937 random(13);
  Query query = randomWire(Eigen::Vector3d(0.0, 0.0, 0.02), random, 15);
  std::normal_distribution<double> motion(0.0, 0.05e-3);
  for (int step = 0; step < 15; ++step)
  {
    ContactSet a, b;
    used.detect(query, a);
    Detector(model, WallLaw{}).detect(query, b);
    expectSameSets(a, b);
    for (Eigen::Vector3d& node : query.nodes)
      node += Eigen::Vector3d(motion(random), motion(random), motion(random));
  }
}

TEST(SmoothDetector, RefusesAMovementOfTheWall)
{
  Detector detector(bentTube(), smoothLaw());
  EXPECT_THROW(detector.moveVertices({0}, {Eigen::Vector3d::Zero()}, 2), std::logic_error);
}

TEST(SmoothDetector, SharesAModelAndCopiesIt)
{
  const std::shared_ptr<const WallModel> model = WallModel::create(bentTube(), WallShape::kSmooth);
  std::shared_ptr<const WallModel> copy = model;
  WallModel::writable(copy);
  ASSERT_NE(copy, model);
  std::mt19937 random(14);
  const Query query = randomWire(Eigen::Vector3d(0.0, 0.0, 0.02), random, 15);
  ContactSet a, b;
  Detector(model, WallLaw{}).detect(query, a);
  Detector(copy, WallLaw{}).detect(query, b);
  expectSameSets(a, b);
}

}  // namespace
}  // namespace endovascular_sim::contact
