#include "fluoroscopy/projection/wire_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "common/error.h"
#include "fluoroscopy/projection/vessel_projection.h"
#include "test/fluoroscopy/shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kRadius = 0.18e-3;

/** Optical depth proportional to the density, as of a monoenergetic beam. */
DeviceCoefficients unity(std::uint32_t /*pixel*/)
{
  return {1.0F, 0.0F, 0.0F, 0.0F};
}

/** Chain of solid cylinders of one attenuation coefficient [1/m]. */
XRayWire chain(const std::vector<Eigen::Vector3d>& nodes, double radius, double attenuation)
{
  XRayWire wire;
  wire.nodes.push_back(nodes.front());
  for (std::size_t i = 1; i < nodes.size(); ++i)
    appendEdge(wire, nodes[i], {{radius, {attenuation, 0.0}}});
  return wire;
}

XRayWire straightWire(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int edges, double radius, double attenuation)
{
  std::vector<Eigen::Vector3d> nodes;
  for (int i = 0; i <= edges; ++i)
    nodes.emplace_back(a + (b - a) * i / edges);
  return chain(nodes, radius, attenuation);
}

double totalLoss(const XRayGeometry& geometry, const XRayWire& wire)
{
  WireProjection projection;
  WireShadow shadow;
  projection.project(geometry, {wire}, unity, shadow);
  double sum = 0.0;
  for (const double transmission : shadow.transmission)
    sum += 1.0 - transmission;
  return sum;
}

/** Integral of 1 − exp(−μ·chord) over the image of a wire of given length, parallel to the detector at depth SOD
 *  [pixel²]. */
double exactLoss(const XRayGeometry& geometry, double length, double radius, double attenuation)
{
  constexpr int kSteps = 200000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i)
  {
    const double q = (i + 0.5) / kSteps;
    sum += (1.0 - std::exp(-attenuation * 2.0 * radius * std::sqrt(1.0 - q * q))) / kSteps;
  }
  const double scale = geometry.focalLength() / geometry.pose().source_to_patient;
  return 2.0 * radius * sum * length * scale * scale;
}

TEST(WireProjection, PreservesTheIntegratedAttenuationAtAnySubPixelShiftAndAngle)
{
  const XRayGeometry geometry{CArmPose{}};
  const double pixel = 0.75 / geometry.focalLength();
  for (const double attenuation : {700.0, 9300.0})  // nitinol, platinum [1/m]
  {
    const double exact = exactLoss(geometry, 0.04, kRadius, attenuation);
    for (double angle = 0.0; angle < M_PI; angle += M_PI / 36.0)
      for (double shift = 0.0; shift < 1.0; shift += 0.1)
      {
        const Eigen::Vector3d along(std::cos(angle), 0.0, std::sin(angle));
        const Eigen::Vector3d across(-std::sin(angle), 0.0, std::cos(angle));
        const Eigen::Vector3d middle = shift * pixel * across;
        const XRayWire wire = straightWire(middle - 0.02 * along, middle + 0.02 * along, 16, kRadius, attenuation);
        EXPECT_NEAR(totalLoss(geometry, wire), exact, 0.02 * exact) << "angle " << angle << " shift " << shift;
      }
  }
}

TEST(WireProjection, EqualsTheProjectionOfAFineMeshOfTheSameCylinder)
{
  CArmPose pose;
  pose.primary_angle = 0.4;
  pose.pixels = 128;
  pose.detector_width = 0.03;  // small pixels: the average over a pixel is close to the value at its centre
  const XRayGeometry geometry(pose);
  const Eigen::Vector3d a(-0.004, -0.003, -0.005), b(0.005, 0.004, 0.006);
  const auto exact = vesselPathLength(geometry, cylinder(a, b, 1.5e-3, 720));
  WireProjection projection;
  WireShadow shadow;
  projection.project(geometry, {straightWire(a, b, 7, 1.5e-3, 1.0)}, unity, shadow);
  std::size_t compared = 0;
  for (std::size_t k = 0; k < shadow.pixels.size(); ++k)
  {
    const double length = exact[shadow.pixels[k]];
    EXPECT_NEAR(-std::log(shadow.transmission[k]), length, length > 2e-3 ? 1e-4 : 1.2e-3);
    compared += length > 2e-3 ? 1 : 0;
  }
  EXPECT_GT(compared, 1000U);
}

TEST(WireProjection, CoversTheJointsOfABentWireExactlyOnce)
{
  // Coarse and fine discretisations of an arc of 20 mm radius have the same volume, and thus the same weak shadow.
  const XRayGeometry geometry{CArmPose{}};
  const auto arc = [](int edges)
  {
    std::vector<Eigen::Vector3d> nodes;
    for (int i = 0; i <= edges; ++i)
      nodes.emplace_back(0.02 * std::cos(M_PI * i / edges), 0.0, 0.02 * std::sin(M_PI * i / edges));
    return chain(nodes, kRadius, 1.0);
  };
  const double exact = exactLoss(geometry, M_PI * 0.02, kRadius, 1.0);
  EXPECT_NEAR(totalLoss(geometry, arc(200)), exact, 0.005 * exact);
  EXPECT_NEAR(totalLoss(geometry, arc(40)), exact, 0.005 * exact);
}

/** Bent wire that begins at the isocentre. */
XRayWire randomWire(std::mt19937& random, double radius, double step, double bend)
{
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.8, 1.2);
  XRayWire wire;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  wire.nodes.push_back(place);
  for (int i = 1; i < 20; ++i)
  {
    place += step * uniform(random) * direction;
    direction = (direction + bend * Eigen::Vector3d(normal(random), normal(random), normal(random))).normalized();
    appendEdge(wire, place, {{radius * uniform(random), {700.0, 0.0}}});
  }
  return wire;
}

/** Random point of one edge's cylinder between its bisecting planes; empty if the sample lies outside. */
std::optional<Eigen::Vector3d> randomPoint(const XRayWire& wire, std::size_t edge, std::mt19937& random)
{
  const auto axis = [&wire](std::size_t j)
  { return Eigen::Vector3d((wire.nodes[j + 1] - wire.nodes[j]).normalized()); };
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  const double radius = wire.profiles[wire.edge_profile[edge]].front().radius;
  const double length = (wire.nodes[edge + 1] - wire.nodes[edge]).norm();
  const Eigen::Vector3d any(normal(random), normal(random), normal(random));
  const Eigen::Vector3d across = (any - any.dot(axis(edge)) * axis(edge)).normalized();
  const Eigen::Vector3d point = wire.nodes[edge] + ((length + 2.0 * radius) * uniform(random) - radius) * axis(edge) +
                                radius * std::sqrt(uniform(random)) * across;
  const Eigen::Vector3d before = axis(edge) + (edge > 0 ? axis(edge - 1) : axis(edge));
  const Eigen::Vector3d after = axis(edge) + (edge + 2 < wire.nodes.size() ? axis(edge + 1) : axis(edge));
  if ((point - wire.nodes[edge]).dot(before) < 0.0 || (point - wire.nodes[edge + 1]).dot(after) > 0.0)
    return std::nullopt;
  return point;
}

TEST(WireProjection, MergesTheEdgesOfAStraightUniformWire)
{
  const XRayGeometry geometry{CArmPose{}};
  const Eigen::Vector3d a(-0.01, 0.002, 0.003), b(0.012, -0.001, 0.007);
  WireProjection projection;
  WireShadow one, many;
  projection.project(geometry, {straightWire(a, b, 1, 1.5e-3, 400.0)}, unity, one);
  projection.project(geometry, {straightWire(a, b, 40, 1.5e-3, 400.0)}, unity, many);
  EXPECT_EQ(one.pixels, many.pixels);
  EXPECT_EQ(one.transmission, many.transmission);
}

TEST(WireProjection, DoesNotMergeAcrossBendsOrChangesOfTheProfile)
{
  const XRayGeometry geometry{CArmPose{}};
  const Eigen::Vector3d a(-0.01, 0.0, 0.0), b(0.01, 0.0, 0.0), aside(0.0, 0.0, 5e-6);
  const XRayWire straight = straightWire(a, b, 4, 0.2e-3, 1.0);
  const double whole = totalLoss(geometry, straight);
  std::vector<Eigen::Vector3d> there_and_back = straight.nodes;  // weak attenuation: losses add up linearly
  for (std::size_t k = 4; k-- > 0;)
    there_and_back.push_back(straight.nodes[k]);
  EXPECT_NEAR(totalLoss(geometry, chain(there_and_back, 0.2e-3, 1.0)), 2.0 * whole, 2e-3 * whole);
  XRayWire thicker = straight;
  thicker.profiles.push_back({{0.3e-3, {1.0, 0.0}}});
  thicker.edge_profile = {0, 1, 1, 0};  // two of four edges with 2.25 times the volume
  EXPECT_NEAR(totalLoss(geometry, thicker), (0.5 + 0.5 * 2.25) * whole, 5e-3 * whole);
  XRayWire mixed = straight;
  mixed.profiles.push_back({{0.2e-3, {2.0, 0.0}}});
  mixed.edge_profile = {0, 1, 0, 0};
  EXPECT_NEAR(totalLoss(geometry, mixed), 1.25 * whole, 2e-3 * whole);
  XRayWire bent = straight;
  bent.nodes[2] += aside;
  WireProjection projection;
  WireShadow seen, seen_straight;
  projection.project(geometry, {bent}, unity, seen);
  projection.project(geometry, {straight}, unity, seen_straight);
  EXPECT_NE(seen.transmission, seen_straight.transmission);
}

TEST(WireProjection, AffectsEveryPixelThatContainsAPointOfTheWire)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-1.0, 1.0);
  int seen = 0;
  for (int trial = 0; trial < 60; ++trial)
  {
    CArmPose pose;
    pose.primary_angle = angle(random);
    pose.secondary_angle = 0.5 * angle(random);
    pose.source_to_patient = trial % 2 == 0 ? 0.75 : 0.15;  // wide cone beam
    const XRayGeometry geometry(pose);
    const XRayWire wire = randomWire(random, trial % 3 == 0 ? 0.2e-3 : 3e-3, trial % 4 < 2 ? 1e-3 : 4e-3, 0.3);
    WireProjection projection;
    WireShadow shadow;
    projection.project(geometry, {wire}, unity, shadow);
    const std::set<std::uint32_t> touched(shadow.pixels.begin(), shadow.pixels.end());
    for (int k = 0; k < 4000; ++k)
    {
      const auto edge = static_cast<std::size_t>(k) % (wire.nodes.size() - 1);
      const std::optional<Eigen::Vector3d> point = randomPoint(wire, edge, random);
      if (!point)
        continue;
      const Eigen::Vector2d place = geometry.project(*point);
      if (!(place.minCoeff() >= 0.0 && place.maxCoeff() <= geometry.pixels() - 1))
        continue;
      ++seen;
      const auto column = static_cast<std::uint32_t>(std::lround(place.x()));
      const auto row = static_cast<std::uint32_t>(std::lround(place.y()));
      EXPECT_EQ(touched.count(row * static_cast<std::uint32_t>(geometry.pixels()) + column), 1U)
          << trial << " " << edge;
    }
  }
  EXPECT_GT(seen, 50000);
}

TEST(WireProjection, IntegratesAWireParallelToTheRay)
{
  CArmPose pose;
  pose.pixels = 65;
  const XRayGeometry geometry(pose);
  const Eigen::Vector3d forward = geometry.axes().col(2);
  WireProjection projection;
  WireShadow shadow;
  projection.project(geometry, {straightWire(-0.01 * forward, 0.01 * forward, 5, 5e-3, 1.0)}, unity, shadow);
  bool found = false;
  for (std::size_t k = 0; k < shadow.pixels.size(); ++k)
    if (shadow.pixels[k] == 32 * 65 + 32)
    {
      EXPECT_NEAR(-std::log(shadow.transmission[k]), 0.02, 1e-5);
      found = true;
    }
  EXPECT_TRUE(found);
}

TEST(WireProjection, MultipliesTheTransmissionsOfCrossingWires)
{
  const XRayGeometry geometry{CArmPose{}};
  WireProjection projection;
  WireShadow shadow;
  const XRayWire wire =
      chain({{-0.01, 0.0, 0.0}, {0.01, 0.0, 0.0}, {0.01, 0.01, 0.0}, {-0.01, 0.01, 0.0}}, 2e-3, 100.0);
  projection.project(geometry, {wire}, unity, shadow);
  double darkest = 1.0;
  for (const double transmission : shadow.transmission)
    darkest = std::min(darkest, transmission);
  EXPECT_LT(darkest, std::exp(-100.0 * 7.8e-3));
}

TEST(WireProjection, IsBitwiseIndependentOfEarlierFrames)
{
  const XRayGeometry geometry{CArmPose{}};
  const XRayWire wire = straightWire({-0.01, 0.001, 0.0}, {0.02, 0.0, 0.03}, 11, kRadius, 700.0);
  WireProjection fresh, used;
  WireShadow expected, shadow;
  fresh.project(geometry, {wire}, unity, expected);
  used.project(geometry, {straightWire({0.0, 0.0, 0.0}, {0.01, 0.0, 0.03}, 4, kRadius, 100.0)}, unity, shadow);
  used.project(geometry, {wire}, unity, shadow);
  EXPECT_EQ(shadow.pixels, expected.pixels);
  EXPECT_EQ(shadow.transmission, expected.transmission);
}

TEST(WireProjection, IgnoresInvisibleEdgesAndDuplicateNodes)
{
  const XRayGeometry geometry{CArmPose{}};
  EXPECT_EQ(totalLoss(geometry, straightWire({1.0, 0.0, 0.0}, {1.0, 0.0, 0.1}, 3, kRadius, 700.0)), 0.0);
  EXPECT_EQ(totalLoss(geometry, straightWire({0.0, 0.8, 0.0}, {0.0, 0.9, 0.0}, 3, kRadius, 700.0)), 0.0);
  EXPECT_EQ(totalLoss(geometry, straightWire({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 3, kRadius, 700.0)), 0.0);
  EXPECT_EQ(totalLoss(geometry, XRayWire{}), 0.0);
}

TEST(WireProjection, RejectsArraysOfInconsistentSize)
{
  const XRayGeometry geometry{CArmPose{}};
  XRayWire wire = straightWire({0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}, 3, kRadius, 700.0);
  wire.edge_profile.pop_back();
  EXPECT_THROW(totalLoss(geometry, wire), InputError);
  wire = straightWire({0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}, 3, kRadius, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(totalLoss(geometry, wire), InputError);
  wire = straightWire({0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}, 3, kRadius, 700.0);
  wire.nodes[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(totalLoss(geometry, wire), InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
