#include "motion/contact/moving_wall.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "test/contact/contact_fixtures.h"

// Contact sets of a moving vessel against those of its moved mesh.

namespace endovascular_sim::motion
{
namespace
{

using contact::ContactSet;
using contact::Detector;
using contact::Feature;
using contact::Query;
using Eigen::Vector3d;

constexpr double kMargin = 0.25e-3;  // m
constexpr double kFacet = 1.4e-3;    // m, edges of the mesh

/** Heart that covers the bent tube; its motion fades out beyond. */
HeartFrame heartOfTube()
{
  HeartFrame frame;
  frame.base = Vector3d(0.0, 0.0, 0.02);
  frame.axis = Vector3d(1.0, 2.0, 2.0).normalized();
  frame.length = 0.08;
  frame.fade.centre = Vector3d(0.0, 0.0, 0.04);
  frame.fade.core = 0.03;
  frame.fade.reach = 0.09;
  return frame;
}

/** Displacement of several millimetres: shift, shortening, shear, rotation and twist. @param share of the amplitude */
MotionField fieldOf(double share)
{
  MotionField field;
  field.shift = share * Vector3d(2e-3, -3e-3, 4e-3);
  field.linear << -0.06, 0.03, -0.02, 0.05, -0.05, 0.04, -0.06, 0.02, -0.09;
  field.linear *= share;
  field.twist = 1.5 * share;
  return field;
}

MotionMap mapOf(double share)
{
  return {heartOfTube(), fieldOf(share), {}};
}

struct Tube
{
  geometry::TriangleMesh mesh = geometry::midpointSubdivision(contact::bentTube(), 2);
  Detector detector{mesh, contact::WallLaw()};
  MapBounds bounds = mapBounds(mapOf(1.0), gridOf(heartOfTube().fade, 0.01));
};

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const MotionMap& map)
{
  for (Vector3d& vertex : mesh.vertices)
    vertex = map.position(vertex);
  return mesh;
}

/** Wire beside the wall of the moved tube.
 *  @param edge length [m]  @param aside distance from the axis [m] */
Query wireIn(const MotionMap& map, double edge, double aside, double radius, double margin = kMargin)
{
  vessel::TubeShape shape;
  shape.radius = 4e-3;
  shape.facet_length = 1e-3;
  shape.pieces = {{0.03, 0.0, 0.0}, {0.04, 50.0, 0.3}, {0.02, 0.0, 0.0}};
  const vessel::CentrelineBranch axis = vessel::tubeCentreline(shape).branches.front();
  Query query;
  for (std::size_t k = 0; k + 1 < axis.points.size(); ++k)
    for (const double share :
         {0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95})
    {
      const Vector3d chord = axis.points[k + 1] - axis.points[k];
      const Vector3d point =
          map.position(axis.points[k] + share * chord + aside * chord.cross(Vector3d(0.3, 1.0, 0.1)).normalized());
      if (point.z() > -0.01 && (query.nodes.empty() || (point - query.nodes.back()).norm() >= edge))
        query.nodes.push_back(point);
    }
  query.radius.assign(query.nodes.size(), radius);
  query.margin.assign(query.nodes.size(), margin);
  return query;
}

Vector3d onWire(const Query& query, const Feature& feature)
{
  const auto j = static_cast<std::size_t>(feature.edge);
  return (1.0 - feature.parameter) * query.nodes[j] + feature.parameter * query.nodes[j + 1];
}

TEST(MovingWall, GivesTheBitsOfItsSourceWhileThePatientRests)
{
  Tube tube;
  MovingWall wall(&tube.detector, tube.bounds);
  Detector plain(tube.mesh, contact::WallLaw());
  const Query query = wireIn(mapOf(0.0), 2e-3, 3.7e-3, 0.2e-3);
  wall.beginStep(mapOf(0.0), mapOf(0.0));
  ContactSet a, b;
  wall.detect(query, a);
  plain.detect(query, b);
  ASSERT_FALSE(b.features.empty());
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t k = 0; k < a.features.size(); ++k)
  {
    EXPECT_EQ(a.features[k].gap, b.features[k].gap);
    EXPECT_EQ(a.features[k].point, b.features[k].point);
  }
  EXPECT_FALSE(wall.moves());
  wall.freeDistances(query, 5e-3, a);
  plain.freeDistances(query, 5e-3, b);
  EXPECT_EQ(a.free_distance, b.free_distance);
}

TEST(MovingWall, AgreesWithADetectorOfTheMovedMesh)
{
  Tube tube;
  const MotionMap map = mapOf(1.0);
  MovingWall wall(&tube.detector, tube.bounds);
  wall.beginStep(map, map);
  Detector exact(moved(tube.mesh, map), contact::WallLaw());
  for (const double radius : {0.18e-3, 1.0e-3})
  {
    const Query query = wireIn(map, 1e-3, 3.85e-3 - radius, radius);
    ContactSet a, b;
    wall.detect(query, a);
    exact.detect(query, b);
    std::size_t common = 0, listed = 0;
    double worst = 0.0, turn = 0.0;
    for (const Feature& e : b.features)
    {
      if (e.gap > 0.5 * kMargin)
        continue;  // at the margin either may have left it out
      ++listed;
      const Feature* same = nullptr;
      for (const Feature& f : a.features)
        if (std::abs(f.edge + f.parameter - e.edge - e.parameter) < 1.0 &&
            (same == nullptr || f.normal.dot(e.normal) > same->normal.dot(e.normal)))
          same = &f;
      if (same == nullptr || same->normal.dot(e.normal) < 0.99)
        continue;
      ++common;
      worst = std::max(worst, std::abs(same->gap - e.gap));
      turn = std::max(turn, std::acos(std::min(1.0, same->normal.dot(e.normal))));
    }
    EXPECT_GT(listed, 20U);
    EXPECT_GT(common, 0.97 * listed) << radius;
    // The closest point of the resting wall is not quite that of the moved one: of second order in the strain. Moved
    // facets are flat, while the map bends them.
    EXPECT_LT(worst, 0.025 * radius + tube.bounds.sag(kFacet)) << radius;
    EXPECT_LT(turn, 0.12);
  }
}

TEST(MovingWall, SeesTheSurfaceOfTheMovedMeshFromEveryPointOfTheWire)
{
  // Brute force: where the moved wall is nearer than the margin, a feature is listed there, with its distance.
  Tube tube;
  const MotionMap map = mapOf(1.0);
  MovingWall wall(&tube.detector, tube.bounds);
  wall.beginStep(map, map);
  const Detector exact(moved(tube.mesh, map), contact::WallLaw());
  const double radius = 0.5e-3;
  int near = 0;
  for (const double aside : {2.6e-3, 2.9e-3, 3.2e-3, 3.45e-3})
  {
    const Query query = wireIn(map, 2e-3, aside, radius);
    ContactSet set;
    wall.detect(query, set);
    for (std::size_t i = 0; i < query.nodes.size(); ++i)
    {
      const double gap = exact.signedDistance(query.nodes[i]) - radius;
      if (gap > 0.9 * kMargin)
        continue;
      ++near;
      double least = 1.0;
      for (const Feature& f : set.features)
        if (std::abs(f.edge + f.parameter - static_cast<double>(i)) <= 1.0)
          least = std::min(least, f.normal.dot(query.nodes[i] - f.point) - radius);
      EXPECT_NEAR(least, gap, 0.025 * radius + tube.bounds.sag(kFacet)) << i << ' ' << aside;
    }
  }
  EXPECT_GT(near, 20);
}

TEST(MovingWall, GivesGapsThatAreDistancesOfTheWireFromThePlanes)
{
  Tube tube;
  const MotionMap map = mapOf(1.0);
  MovingWall wall(&tube.detector, tube.bounds);
  wall.beginStep(map, map);
  const Query query = wireIn(map, 2e-3, 3.3e-3, 0.5e-3);
  ContactSet set;
  wall.detect(query, set);
  ASSERT_FALSE(set.features.empty());
  for (const Feature& f : set.features)
  {
    EXPECT_NEAR(f.gap, f.normal.dot(onWire(query, f) - f.point) - 0.5e-3, 1e-15);
    EXPECT_NEAR(f.normal.norm(), 1.0, 1e-14);
    EXPECT_LT(f.gap, kMargin);
  }
}

TEST(MovingWall, GivesFreeDistancesWithinWhichNoUnlistedPartOfTheMovedWallLies)
{
  Tube tube;
  const MotionMap map = mapOf(1.0);
  MovingWall wall(&tube.detector, tube.bounds);
  wall.beginStep(map, map);
  const Detector exact(moved(tube.mesh, map), contact::WallLaw());
  const double radius = 0.3e-3;
  int longer = 0;
  for (const double aside : {0.0, 1e-3, 2e-3, 3e-3})
  {
    Query query = wireIn(map, 2e-3, aside, radius);
    ContactSet set;
    wall.freeDistances(query, 3e-3, set);
    ASSERT_EQ(set.free_distance.size(), query.nodes.size() - 1);
    for (std::size_t j = 0; j + 1 < query.nodes.size(); ++j)
    {
      if (set.free_distance[j] <= kMargin)
        continue;  // no more than the margins, within which features are listed
      ++longer;
      for (int k = 0; k <= 10; ++k)
      {
        const Vector3d point = query.nodes[j] + 0.1 * k * (query.nodes[j + 1] - query.nodes[j]);
        EXPECT_GE(exact.signedDistance(point) - radius, set.free_distance[j] - 1e-6) << aside << ' ' << j;
      }
    }
  }
  EXPECT_GT(longer, 50);
}

TEST(MovingWall, CarriesNodesAndFeaturesSoThatTheirPlacesAtRestStay)
{
  Tube tube;
  const MotionMap from = mapOf(0.6), to = mapOf(0.62);
  MovingWall wall(&tube.detector, tube.bounds);
  wall.beginStep(from, to);
  Query query = wireIn(from, 2e-3, 3.4e-3, 0.5e-3);
  ContactSet set;
  wall.detect(query, set);
  ASSERT_GT(set.features.size(), 5U);
  std::vector<Feature> features = set.features;
  contact::WallTravel travel;
  wall.move(0.0, 1.0, query.nodes, 0, travel);
  wall.carry(features);
  double farthest = 0.0;
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
  {
    const Vector3d rest = from.pullBack(query.nodes[i]);
    EXPECT_NEAR((query.nodes[i] + travel.displacement[i] - to.position(rest)).norm(), 0.0, 1e-13);
    farthest = std::max(farthest, travel.displacement[i].norm());
    query.nodes[i] += travel.displacement[i];
  }
  EXPECT_GT(farthest, 0.05e-3);
  ContactSet after;
  wall.detect(query, after);  // at the map after the move
  for (const Feature& f : features)
  {
    const auto same =
        std::find_if(after.features.begin(), after.features.end(),
                     [&f](const Feature& g)
                     { return g.id == f.id && std::abs(g.edge + g.parameter - f.edge - f.parameter) < 1e-6; });
    if (same == after.features.end())
      continue;
    EXPECT_NEAR((same->point - f.point).norm(), 0.0, 1e-9);
    EXPECT_NEAR((same->normal - f.normal).norm(), 0.0, 1e-6);
  }
}

TEST(MovingWall, TurnsNodesWithTheWallOfARigidRotation)
{
  // The heart's core turns as a rigid body: every node there turns by the same vector.
  const HeartFrame frame = heartOfTube();
  const auto turned = [&frame](double angle)
  {
    MotionField field;
    field.linear = Eigen::AngleAxisd(angle, Vector3d(0.6, 0.0, 0.8)).toRotationMatrix() - Eigen::Matrix3d::Identity();
    return MotionMap(frame, field, {});
  };
  Tube tube;
  MovingWall wall(&tube.detector, tube.bounds);
  wall.beginStep(turned(0.1), turned(0.101));
  const std::vector<Vector3d> points = {frame.fade.centre, frame.fade.centre + Vector3d(0.01, 0.0, 0.005)};
  contact::WallTravel travel;
  wall.move(0.0, 1.0, points, 0, travel);
  for (const Vector3d& turn : travel.turn)
    EXPECT_NEAR((turn - 1e-3 * Vector3d(0.6, 0.0, 0.8)).norm(), 0.0, 2e-9);
  wall.move(0.5, 1.0, points, 1, travel);
  EXPECT_TRUE(travel.turn[0].isZero(0.0)) << "a node before the first one is not moved";
  EXPECT_NEAR((travel.turn[1] - 0.5e-3 * Vector3d(0.6, 0.0, 0.8)).norm(), 0.0, 2e-9);
}

TEST(MovingWall, KeepsTheFeaturesOfAnEarlierSetWhenNoAnswerComes)
{
  struct Silent : contact::ContactSource
  {
    void detect(const Query& /*query*/, ContactSet& set) override { set.stale = true; }
    void freeDistances(const Query& /*query*/, double /*wanted*/, ContactSet& set) override { set.stale = true; }
  } silent;
  Tube tube;
  MovingWall wall(&silent, tube.bounds);
  wall.beginStep(mapOf(1.0), mapOf(1.0));
  ContactSet set;
  set.features.resize(3);
  wall.detect(wireIn(mapOf(1.0), 2e-3, 3e-3, 0.5e-3), set);
  EXPECT_TRUE(set.stale);
  EXPECT_EQ(set.features.size(), 3U);
}

}  // namespace
}  // namespace endovascular_sim::motion
