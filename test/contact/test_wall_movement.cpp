#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "contact/detector.h"
#include "geometry/loop_subdivision.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

geometry::TriangleMesh fineTube()
{
  return geometry::midpointSubdivision(bentTube(), 2);
}

TEST(WallMovement, GivesBitForBitTheWallOfTheMovedMesh)
{
  geometry::TriangleMesh mesh = fineTube();
  Wall wall(mesh);
  for (double z : {0.01, 0.02, 0.022})
  {
    const Movement movement = pushOut(mesh, {0.0, 0.0, z}, 6e-3, 0.3);
    ASSERT_GT(movement.indices.size(), 50U);
    apply(movement, mesh);
    const Wall::Changes& changes = wall.moveVertices(movement.indices, movement.positions);
    EXPECT_LT(changes.triangles.size(), mesh.triangles.size() / 2);
    expectSameWalls(wall, Wall(mesh));
  }
}

TEST(WallMovement, GivesTheBitsOfADetectorOfTheMovedMesh)
{
  geometry::TriangleMesh mesh = fineTube();
  Detector moving(mesh, WallLaw{});
  std::mt19937 random(7);
  std::vector<Query> wires;
  for (int k = 0; k < 30; ++k)
    wires.push_back(randomWire({0.0, 0.0, 0.001 * k}, random, 20));
  std::size_t features = 0;
  std::size_t changed = 0;
  for (std::uint64_t version = 2; version < 8; ++version)
  {
    // The lists were built for the previous shape.
    ContactSet before, after, fresh;
    Detector old(mesh, WallLaw{}, version);
    const double z = 0.004 * static_cast<double>(version);
    const Movement movement = pushOut(mesh, {1e-3, 0.0, z}, 5e-3, version % 2 == 0 ? 0.4 : -0.3);
    apply(movement, mesh);
    for (const Query& wire : wires)
      moving.detect(wire, before);
    moving.moveVertices(movement.indices, movement.positions, version);
    Detector fresh_detector(mesh, WallLaw{}, version);
    for (const Query& wire : wires)
    {
      old.detect(wire, before);
      moving.detect(wire, after);
      fresh_detector.detect(wire, fresh);
      expectSameSets(after, fresh);
      features += after.features.size();
      bool same = before.features.size() == after.features.size();
      for (std::size_t k = 0; same && k < after.features.size(); ++k)
        same = before.features[k].gap == after.features[k].gap;
      changed += same ? 0 : 1;
      moving.freeDistances(wire, 0.01, after);
      fresh_detector.freeDistances(wire, 0.01, fresh);
      expectSameSets(after, fresh);
      EXPECT_EQ(moving.signedDistance(wire.nodes[5]), fresh_detector.signedDistance(wire.nodes[5]));
    }
  }
  EXPECT_GT(features, 300U);
  EXPECT_GT(changed, 20U) << "the movements must change contacts";
}

/** Moves a wall and expects the contact set of a new detector. @return the set */
ContactSet contactsAfter(const Movement& movement, std::uint64_t version, const Query& wire,
                         geometry::TriangleMesh& mesh, Detector& moving)
{
  ContactSet after, fresh;
  apply(movement, mesh);
  moving.moveVertices(movement.indices, movement.positions, version);
  moving.detect(wire, after);
  Detector fresh_detector(mesh, WallLaw{}, version);
  fresh_detector.detect(wire, fresh);
  expectSameSets(after, fresh);
  return after;
}

TEST(WallMovement, GivesTheBitsOfANewDetectorWhenTheWallRecedesInSmallSteps)
{
  geometry::TriangleMesh mesh = fineTube();
  Detector moving(mesh, WallLaw{});
  Query wire;
  wire.margin.assign(20, 0.25e-3);
  for (int k = 0; k < 20; ++k)
  {
    wire.nodes.emplace_back(3.5e-3, 0.0, 0.001 * k);
    wire.radius.push_back(0.4e-3);
  }
  ContactSet after;
  moving.detect(wire, after);
  const std::size_t touching = after.features.size();
  ASSERT_GT(touching, 10U);
  for (std::uint64_t step = 2; step < 40; ++step)
    after = contactsAfter(pushOut(mesh, {0.0, 0.0, 0.01}, 12e-3, 0.02), step, wire, mesh, moving);
  EXPECT_LT(after.features.size(), touching);
}

TEST(WallMovement, GivesTheBitsOfANewDetectorWhenFacetsTiltWithinTheSkin)
{
#ifdef ENDOVASCULAR_SANITIZED
  constexpr int kSubdivisions = 2;  // a quarter of the facets: sanitizers slow the test down by a factor of 20
#else
  constexpr int kSubdivisions = 3;
#endif
  std::mt19937 random(11);
  std::uniform_real_distribution<double> off(-0.14e-3, 0.14e-3);  // m, less than the skin of 0.15 mm
  std::size_t changed = 0;
  for (int trial = 0; trial < 4; ++trial)
  {
    geometry::TriangleMesh mesh = geometry::midpointSubdivision(bentTube(), kSubdivisions);
    const Wall start(mesh);
    Detector moving(mesh, WallLaw{});
    Query wire;
    wire.margin.assign(250, 0.25e-3);
    for (int k = 0; k < 250; ++k)  // a helix
    {
      wire.nodes.emplace_back(Eigen::AngleAxisd(trial + 0.2 * k, Eigen::Vector3d::UnitZ()) *
                              Eigen::Vector3d(3.4e-3, 0.0, 0.1e-3 * k));
      wire.radius.push_back(0.4e-3);
    }
    ContactSet before;
    for (std::uint64_t step = 2; step < 4; ++step)
    {
      // Facets tilt that have never moved before, or that have moved very little.
      const double scale = (trial + step) % 2 == 0 ? 1.0 : 1e-3;
      moving.detect(wire, before);
      Movement movement;
      for (std::size_t v = 0; v < mesh.vertices.size(); v += 2)
      {
        movement.indices.push_back(static_cast<int>(v));
        movement.positions.push_back(mesh.vertices[v] + scale * off(random) * start.vertex_normals[v]);
      }
      const ContactSet after = contactsAfter(movement, step, wire, mesh, moving);
      changed += before.features.size() != after.features.size();
    }
  }
  EXPECT_GE(changed, 4U);
}

}  // namespace
}  // namespace endovascular_sim::contact
