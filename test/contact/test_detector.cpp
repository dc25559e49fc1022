#include "contact/detector.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "geometry/loop_subdivision.h"
#include "geometry/mesh_distance.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

bool same(const Feature& a, const Feature& b)
{
  return a.edge == b.edge && a.parameter == b.parameter && a.point == b.point && a.normal == b.normal &&
         a.gap == b.gap && a.triangle == b.triangle && a.id == b.id;
}

/** Expects the features of a new detector from one that has answered other queries. @return number of features */
std::size_t expectSameAsFresh(Detector& warm, const geometry::TriangleMesh& mesh, const Query& query)
{
  ContactSet from_warm;
  warm.detect(query, from_warm);
  Detector fresh(mesh, WallLaw{});
  ContactSet from_fresh;
  fresh.detect(query, from_fresh);
  EXPECT_EQ(from_warm.features.size(), from_fresh.features.size());
  for (std::size_t f = 0; f < std::min(from_warm.features.size(), from_fresh.features.size()); ++f)
    EXPECT_TRUE(same(from_warm.features[f], from_fresh.features[f]));
  return from_warm.features.size();
}

/** Smallest gap over the listed features of one node (by whole-wire index), or infinity. */
double smallestGap(const ContactSet& set, int node)
{
  double gap = std::numeric_limits<double>::infinity();
  for (const Feature& feature : set.features)
    if ((feature.edge == node && feature.parameter == 0.0) || (feature.edge + 1 == node && feature.parameter == 1.0))
      gap = std::min(gap, feature.gap);
  return gap;
}

void checkAgainstBruteForce(const geometry::TriangleMesh& mesh, int wires)
{
  Detector detector(mesh, WallLaw{});
  std::mt19937 random(21);
  std::uniform_int_distribution<std::size_t> any_triangle(0, mesh.triangles.size() - 1);
  constexpr double kWide = 1.1e-3;  // m, radius of a balloon
  int contacts = 0;
  int wide_contacts = 0;
  for (int trial = 0; trial < 2 * wires; ++trial)
  {
    const std::size_t t = any_triangle(random);
    const Eigen::Vector3d start = mesh.vertices[mesh.triangles[t][0]] + 1e-3 * detector.wall().normals[t];
    Query query = randomWire(start, random, 25);
    if (trial % 2 == 1)
    {
      query.radius.assign(query.nodes.size(), kWide);
      query.margin.assign(query.nodes.size(), 0.22e-3);
    }
    ContactSet set;
    detector.detect(query, set);
    for (std::size_t i = 0; i < query.nodes.size(); ++i)
    {
      int triangle = -1;
      const double distance = bruteDistance(detector.wall(), query.nodes[i], triangle);
      const double sign = geometry::windingNumber(mesh, query.nodes[i]) > 0.5 ? 1.0 : -1.0;
      EXPECT_NEAR(detector.signedDistance(query.nodes[i]), sign * distance, 1e-12);
      const double gap = sign * distance - query.radius[i];
      if (sign > 0.0 && gap < query.margin[i] - 1e-9)
      {
        EXPECT_NEAR(smallestGap(set, query.first_node + static_cast<int>(i)), gap, 1e-12);
        (query.radius[i] == kWide ? wide_contacts : contacts) += 1;
      }
      else if (sign > 0.0 && gap > query.margin[i] + 1e-9)
      {
        EXPECT_EQ(smallestGap(set, query.first_node + static_cast<int>(i)), std::numeric_limits<double>::infinity());
      }
      else if (sign < 0.0 && distance < 0.85e-3)
      {
        EXPECT_NEAR(smallestGap(set, query.first_node + static_cast<int>(i)), gap, 1e-12);
      }
    }
  }
  EXPECT_GT(contacts, wires);
  EXPECT_GT(wide_contacts, wires / 2);
}

TEST(Detector, FindsTheNearestGapOfEachNodeInATube)
{
  checkAgainstBruteForce(bentTube(), 40);
}

TEST(Detector, FindsTheNearestGapOfNodesAboveTheVerticesOfABumpyTube)
{
  std::mt19937 random(23);
  std::normal_distribution<double> normal;
  for (double bump : {0.05, 0.2})
  {
    const geometry::TriangleMesh mesh = bumpyTube(bump);
    Detector detector(mesh, WallLaw{});
    std::uniform_int_distribution<std::size_t> any_vertex(0, mesh.vertices.size() - 1);
    int contacts = 0;
    for (int trial = 0; trial < 400; ++trial)
    {
      const std::size_t v = any_vertex(random);
      const Eigen::Vector3d off(normal(random), normal(random), normal(random));
      const Eigen::Vector3d up = (detector.wall().vertex_normals[v] + bump * off).normalized();
      Query query;
      query.margin = {0.5e-3, 0.5e-3};
      query.first_node = 3;
      query.radius.assign(2, 0.4e-3);
      query.nodes = {mesh.vertices[v] + 0.6e-3 * up, mesh.vertices[v] + 2e-3 * up};
      ContactSet set;
      detector.detect(query, set);
      int triangle = -1;
      const double gap = bruteDistance(detector.wall(), query.nodes[0], triangle) - query.radius[0];
      if (geometry::windingNumber(mesh, query.nodes[0]) < 0.5)
        continue;
      EXPECT_NEAR(smallestGap(set, query.first_node), gap, 1e-12);
      ++contacts;
    }
    EXPECT_GT(contacts, 300);
  }
}

TEST(Detector, FindsTheNearestGapOfEachNodeInARealAorta)
{
  const std::string file = dataFile("aortic_arch_tree.obj");
  if (file.empty())
    GTEST_SKIP() << "set ENDOVASCULAR_DATA_DIR to the folder of aortic_arch_tree.obj";
  checkAgainstBruteForce(realMesh(file), 40);
}

TEST(Detector, GivesTheSameBitsWithReusedAndWithNewLists)
{
  const geometry::TriangleMesh mesh = bentTube();
  Detector warm(mesh, WallLaw{});
  std::mt19937 random(8);
  Query query = randomWire(Eigen::Vector3d(0.0, 0.0, 0.01), random, 30);
  for (int step = 0; step < 60; ++step)
  {
    for (Eigen::Vector3d& node : query.nodes)
      node += Eigen::Vector3d(1.5e-4, 0.7e-4, 1e-4);
    expectSameAsFresh(warm, mesh, query);
  }
}

TEST(Detector, GivesTheSameBitsToAWireThatSlidesForwardsAndBack)
{
  const geometry::TriangleMesh mesh = geometry::midpointSubdivision(bentTube(), 2);
  Detector warm(mesh, WallLaw{});
  std::mt19937 random(12);
  const Query wire = randomWire(Eigen::Vector3d(0.0, 0.0, 0.012), random, 40);
  std::size_t found = 0;
  for (int step = 0; step < 120; ++step)
  {
    const double along = 0.02 * (step < 70 ? step : 140 - step);  // in edges
    Query query = wire;
    query.nodes.resize(35);
    query.radius.resize(35);
    for (std::size_t i = 0; i < query.nodes.size(); ++i)
    {
      const auto k = i + static_cast<std::size_t>(along);
      const double share = along - std::floor(along);
      query.nodes[i] = (1.0 - share) * wire.nodes[k] + share * wire.nodes[k + 1];
    }
    found += expectSameAsFresh(warm, mesh, query);
  }
  EXPECT_GT(found, 100U);
}

TEST(Detector, UsesTheMarginOfEachNodeIndependentlyOfEarlierQueries)
{
  const geometry::TriangleMesh mesh = bentTube();
  Detector warm(mesh, WallLaw{});
  Query query;
  for (int i = 0; i < 30; ++i)
  {
    query.nodes.emplace_back(2.6e-3, 0.0, 0.6e-3 * i);
    query.radius.push_back(0.4e-3);
  }
  std::size_t more = 0;
  for (int step = 0; step < 80; ++step)
  {
    for (Eigen::Vector3d& node : query.nodes)
      node += 1e-4 * (step % 20 < 10 ? 1.0 : -1.0) * Eigen::Vector3d(0.5, 0.7, 0.1);
    const bool widened = step % 7 < 4;
    query.margin.assign(30, 0.3e-3);
    if (widened)
      std::fill(query.margin.begin() + 8, query.margin.begin() + 20, 0.9e-3);
    expectSameAsFresh(warm, mesh, query);
    Query wide = query;
    wide.margin.assign(30, 0.9e-3);
    const auto ofWidenedNodes = [&](const Query& queried)
    {
      ContactSet set;
      Detector(mesh, WallLaw{}).detect(queried, set);
      std::vector<std::int64_t> ids;
      for (const Feature& feature : set.features)
        if (feature.edge >= 8 && feature.edge < 19)
          ids.push_back(feature.id);
      return ids;
    };
    const std::vector<std::int64_t> listed = ofWidenedNodes(query);
    if (widened)
    {
      EXPECT_EQ(listed, ofWidenedNodes(wide)) << step;
    }
    else
      more += ofWidenedNodes(wide).size() - listed.size();
  }
  EXPECT_GT(more, 100U);
}

TEST(Detector, FindsTheSameGapsInASubdividedMesh)
{
  const geometry::TriangleMesh mesh = bentTube();
  Detector coarse(mesh, WallLaw{});
  Detector fine(geometry::midpointSubdivision(mesh, 2), WallLaw{});
  std::mt19937 random(9);
  for (int trial = 0; trial < 30; ++trial)
  {
    const Query query = randomWire(Eigen::Vector3d(0.0, 0.0, 0.02), random, 20);
    ContactSet from_coarse, from_fine;
    coarse.detect(query, from_coarse);
    fine.detect(query, from_fine);
    for (std::size_t i = 0; i < query.nodes.size(); ++i)
    {
      const int node = query.first_node + static_cast<int>(i);
      const double a = smallestGap(from_coarse, node);
      const double b = smallestGap(from_fine, node);
      if (std::isfinite(a) || std::isfinite(b))
      {
        EXPECT_NEAR(a, b, 1e-9);
      }
    }
  }
}

TEST(Detector, FindsAContactExactlyAboveAnEdgeOrAVertexBetweenCoplanarTriangles)
{
  // The flat end cap of a straight tube, subdivided; the node is above one of its inner vertices.
  vessel::TubeShape shape;
  shape.radius = 4e-3;
  shape.facet_length = 5e-3;
  shape.facets_around = 8;
  shape.pieces = {{0.03, 0.0, 0.0}};
  const geometry::TriangleMesh mesh = geometry::midpointSubdivision(vessel::tubeMesh(shape), 1);
  Detector detector(mesh, WallLaw{});
  const Eigen::Vector3d above(0.0, 0.0, 0.03 - 0.6e-3);  // the cap's centre is a vertex
  Query query;
  query.margin = {0.5e-3, 0.5e-3};
  query.nodes = {above - Eigen::Vector3d(0.0, 0.0, 2e-3), above};
  query.radius = {0.4e-3, 0.4e-3};
  ContactSet set;
  detector.detect(query, set);
  EXPECT_NEAR(smallestGap(set, 1), 0.2e-3, 1e-9);
}

/** A coarse bend, whose inner side has reflex edges, and a wire's edge above the middle of one of them. */
class EdgeEdgeContact : public testing::Test
{
protected:
  EdgeEdgeContact()
  {
    for (std::size_t e = 0; e < detector_.wall().edges.size(); ++e)
      if (detector_.wall().edges[e].reflex_angle > 0.1)
        reflex_edge_ = static_cast<int>(e);
  }

  const WallEdge& reflexEdge() const { return detector_.wall().edges[reflex_edge_]; }

  /** @param tilt rotation of the wire's edge about the reflex edge; half the reflex angle lies along a facet [rad]
   *  @return gap of the edge-edge contact; infinite without one [m] */
  double contactGap(double tilt)
  {
    const Eigen::Vector3d& begin = detector_.wall().vertices[reflexEdge().vertices[0]];
    const Eigen::Vector3d& end = detector_.wall().vertices[reflexEdge().vertices[1]];
    const Eigen::Vector3d along = (end - begin).normalized();
    const Eigen::Vector3d normal = reflexEdge().normal.normalized();
    const Eigen::Vector3d direction =
        std::cos(tilt) * along.cross(normal) + std::sin(tilt) * (normal - normal.dot(along) * along);
    const Eigen::Vector3d over = 0.5 * (begin + end) + 0.5e-3 * normal;
    Query query;
    query.margin = {0.5e-3, 0.5e-3};
    query.nodes = {over - 0.9e-3 * direction, over + 0.9e-3 * direction};
    query.radius = {0.4e-3, 0.4e-3};
    detector_.detect(query, set_);
    for (const Feature& feature : set_.features)
      if (feature.parameter > 0.0 && feature.parameter < 1.0)
        return feature.gap;
    return std::numeric_limits<double>::infinity();
  }

  Detector detector_{bentTube(), WallLaw{}};
  ContactSet set_;
  int reflex_edge_ = 0;
};

TEST_F(EdgeEdgeContact, LiesBetweenTheNodes)
{
  EXPECT_NEAR(contactGap(0.0), 0.1e-3, 1e-9);
  const auto contact = std::find_if(set_.features.begin(), set_.features.end(),
                                    [](const Feature& f) { return f.parameter > 0.0 && f.parameter < 1.0; });
  EXPECT_NEAR(contact->parameter, 0.5, 1e-6);
}

TEST_F(EdgeEdgeContact, IsFoundWhenTheWireLiesAlongAFacet)
{
  const double along_facet = 0.5 * reflexEdge().reflex_angle;
  for (const double beyond : {-0.05, 0.0, 0.05})
  {
    const double tilt = along_facet + beyond * reflexEdge().reflex_angle;
    EXPECT_NEAR(contactGap(tilt), 0.5e-3 * std::cos(tilt) - 0.4e-3, 1e-9) << beyond;
    EXPECT_NEAR(contactGap(-tilt), 0.5e-3 * std::cos(tilt) - 0.4e-3, 1e-9) << beyond;
  }
  EXPECT_FALSE(std::isfinite(contactGap(along_facet + 0.3 * reflexEdge().reflex_angle)))
      << "the nearest point is a node";
}

TEST(Detector, GivesEachContactTheFrictionOfItsRegion)
{
  WallLaw law;
  law.friction = 0.1;
  law.regions = {{Eigen::Vector3d(0.0, 0.0, 0.02), 8e-3, 0.3}};
  Detector detector(bentTube(), law);
  std::mt19937 random(9);
  int inside = 0;
  int outside = 0;
  for (int trial = 0; trial < 30; ++trial)
  {
    ContactSet set;
    detector.detect(randomWire(Eigen::Vector3d(0.0, 0.0, 0.02), random, 20), set);
    for (const Feature& feature : set.features)
    {
      const bool in_region = (feature.point - law.regions[0].centre).norm() <= law.regions[0].radius;
      EXPECT_EQ(feature.friction, in_region ? 0.3 : 0.1);
      ++(in_region ? inside : outside);
    }
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(outside, 10);
}

TEST(Detector, GivesFreeDistancesBelowTheClearanceAndUpToTheWantedOne)
{
  const geometry::TriangleMesh mesh = bentTube();
  Detector detector(mesh, WallLaw{});
  std::mt19937 random(31);
  for (int trial = 0; trial < 20; ++trial)
  {
    Query query = randomWire(Eigen::Vector3d(0.0, 0.0, 0.02), random, 6);
    const double wanted = trial % 2 == 0 ? 0.8e-3 : 30e-3;
    ContactSet set;
    detector.freeDistances(query, wanted, set);
    double reach = 0.0;
    for (std::size_t e = 0; e + 1 < query.nodes.size(); ++e)
      reach = std::max(reach, wanted + 0.4e-3 + 0.5 * (query.nodes[e + 1] - query.nodes[e]).norm());
    for (std::size_t e = 0; e + 1 < query.nodes.size(); ++e)
    {
      int unused = -1;
      const double ends = std::min(reach, bruteDistance(detector.wall(), query.nodes[e], unused)) +
                          std::min(reach, bruteDistance(detector.wall(), query.nodes[e + 1], unused));
      const double bound = 0.5 * (ends - (query.nodes[e + 1] - query.nodes[e]).norm()) - 0.4e-3;
      EXPECT_GE(set.free_distance[e], std::min(wanted, bound) - 1e-12);
      for (double t : {0.0, 0.25, 0.5, 0.75, 1.0})
      {
        int triangle = -1;
        const Eigen::Vector3d p = (1.0 - t) * query.nodes[e] + t * query.nodes[e + 1];
        const double clearance = bruteDistance(detector.wall(), p, triangle) - 0.4e-3;
        EXPECT_LE(set.free_distance[e], std::max(query.margin[e], clearance) + 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace endovascular_sim::contact
