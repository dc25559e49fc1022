#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "contact/detector.h"
#include "vessel/anatomy/tube.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kRadius = 4e-3;  // m, of the channel
constexpr double kBend = 20e-3;   // m, of its axis

/** A quarter of a torus, beginning at the origin along z and bending towards x, between two straight pieces. */
geometry::TriangleMesh bend(int facets_around)
{
  vessel::TubeShape shape;
  shape.radius = kRadius;
  shape.facets_around = facets_around;
  shape.facet_length = 2.0 * M_PI * kRadius / facets_around;
  shape.pieces = {{0.03, 0.0, 0.0}, {0.5 * M_PI * kBend, 1.0 / kBend, 0.0}, {0.03, 0.0, 0.0}};
  return vessel::tubeMesh(shape);
}

/** Largest relative errors of the curvature around and along the channel, in the middle of its bend. */
std::pair<double, double> errorsInTheBend(int facets_around)
{
  const Wall wall(bend(facets_around));
  const Eigen::Vector3d centre(kBend, 0.0, 0.03);  // of the torus
  std::pair<double, double> errors{0.0, 0.0};
  for (std::size_t t = 0; t < wall.triangles.size(); ++t)
  {
    const Eigen::Vector3i& corners = wall.triangles[t];
    const Eigen::Vector3d centroid =
        (wall.vertices[corners[0]] + wall.vertices[corners[1]] + wall.vertices[corners[2]]) / 3.0 - centre;
    const double angle = std::atan2(centroid.z(), -centroid.x());
    if (angle < 0.4 || angle > 1.1)
      continue;
    const Eigen::Vector3d along(std::sin(angle), 0.0, std::cos(angle));
    const Eigen::Vector3d around = wall.normals[t].cross(along);
    // Radial offset from the channel's axis in radii of the channel: −1 on the inside of the bend.
    const double side = (std::hypot(centroid.x(), centroid.z()) - kBend) / kRadius;
    const double expected_along = side / (kBend + side * kRadius);
    errors.first = std::max(errors.first, std::abs(kRadius * around.dot(wall.curvature[t] * around) - 1.0));
    errors.second = std::max(errors.second, kRadius * std::abs(along.dot(wall.curvature[t] * along) - expected_along));
  }
  return errors;
}

TEST(WallCurvature, ConvergesToThatOfATorus)
{
  const auto [coarse_around, coarse_along] = errorsInTheBend(24);
  const auto [fine_around, fine_along] = errorsInTheBend(48);
  const auto [finest_around, finest_along] = errorsInTheBend(96);
  EXPECT_LT(fine_around, 0.05);
  EXPECT_LT(fine_along, 0.05);
  EXPECT_LT(finest_around, 0.5 * fine_around);
  EXPECT_LT(fine_around, 0.5 * coarse_around);
  EXPECT_LT(finest_along, 0.5 * coarse_along);
}

Feature nearestFeature(const geometry::TriangleMesh& mesh, const Eigen::Vector3d& node,
                       const Eigen::Vector3d& direction)
{
  Detector detector(mesh, WallLaw{});
  Query query;
  query.margin = {1e-3, 1e-3};
  query.nodes = {node, node + 1e-3 * direction};
  query.radius = {0.4e-3, 0.4e-3};
  ContactSet set;
  detector.detect(query, set);
  Feature nearest;
  nearest.gap = 1.0;
  for (const Feature& feature : set.features)
    if (feature.gap < nearest.gap)
      nearest = feature;
  return nearest;
}

TEST(WallCurvature, GivesTheClearanceRadiusAcrossTheWire)
{
  const geometry::TriangleMesh mesh = bend(48);
  const Eigen::Vector3d node(0.1e-3, kRadius - 1e-3, 0.015);
  EXPECT_NEAR(nearestFeature(mesh, node, Eigen::Vector3d::UnitZ()).clearance_radius, kRadius - 0.4e-3, 0.05 * kRadius);
  // Across a wire in the circumferential direction the wall is straight.
  EXPECT_GT(nearestFeature(mesh, node, Eigen::Vector3d::UnitX()).clearance_radius, 100.0 * kRadius);
}

}  // namespace
}  // namespace endovascular_sim::contact
