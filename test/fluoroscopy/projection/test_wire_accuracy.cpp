// Comparison of the projection of instruments with 33 × 33 rays per pixel.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "fluoroscopy/projection/wire_projection.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kRays = 33;  // per side of a pixel
constexpr DeviceCoefficients kBeam{0.0085F, 0.004F, 0.008F, 0.0195F};

using Points = std::vector<Eigen::Vector3d>;

/** Guide catheter over two thirds of the length, a nitinol wire, and a platinum tip over the last @p tip edges. */
XRayWire stack(const Points& points, std::size_t tip, bool catheter)
{
  const WireProfile wire = {{0.18e-3, {6251.0, -800.0}}}, platinum = {{0.18e-3, {50e3, 20e3}}};
  const WireProfile both = {{1.0e-3, {1390.0, 3500.0}}, {0.9e-3, {-1390.0, -3500.0}}, {0.18e-3, {6251.0, -800.0}}};
  XRayWire result;
  result.nodes.push_back(points.front());
  const std::size_t edges = points.size() - 1;
  for (std::size_t j = 0; j < edges; ++j)
    appendEdge(result, points[j + 1], catheter && j < edges * 2 / 3 ? both : edges - j <= tip ? platinum : wire);
  return result;
}

/** Chord of a ray in a layer between the clipping planes of its edge [m]. */
double chord(const WireEdge& edge, double radius, const Eigen::Vector3d& ray)
{
  const double along = ray.dot(edge.axis), a = ray.squaredNorm() - along * along;
  const double off = ray.dot(edge.moment), discriminant = a * radius * radius - off * off;
  if (!(a > 1e-14) || discriminant <= 0.0)
    return 0.0;
  const double middle = ray.dot(edge.across) / a, half = std::sqrt(discriminant) / a;
  double from = middle - half, to = middle + half;
  const auto cut = [&](const Eigen::Vector3d& normal, const Eigen::Vector3d& point)
  {
    const double slope = normal.dot(ray), t = normal.dot(point) / slope;
    if (slope > 0.0)
      from = std::max(from, t);
    else if (slope < 0.0)
      to = std::min(to, t);
    else if (normal.dot(point) > 0.0)
      to = from;
  };
  cut(edge.begin_normal, edge.begin);
  cut(-edge.end_normal, edge.end);
  return to > from ? (to - from) * ray.norm() : 0.0;
}

double bruteForce(const XRayGeometry& geometry, const std::vector<WireEdge>& edges, int row, int column)
{
  std::vector<const WireEdge*> near;
  const Eigen::Vector3d centre = geometry.ray(column, row).normalized();
  for (const WireEdge& edge : edges)
  {
    const Eigen::Vector3d middle = 0.5 * (edge.begin + edge.end);
    if (middle.cross(centre).norm() < 0.5 * edge.length + 2.5 * edge.radius + 1.2 / geometry.focalLength() * middle.z())
      near.push_back(&edge);
  }
  double sum = 0.0;
  for (int i = 0; i < kRays; ++i)
    for (int j = 0; j < kRays; ++j)
    {
      const Eigen::Vector3d ray = geometry.ray(column + (i + 0.5) / kRays - 0.5, row + (j + 0.5) / kRays - 0.5);
      double steel = 0.0, water = 0.0;
      for (const WireEdge* edge : near)
        for (const WireLayer& layer : *edge->profile)
        {
          const double length = chord(*edge, layer.radius, ray);
          steel += length * layer.density.steel;
          water += length * layer.density.water;
        }
      sum += std::exp(-static_cast<double>(opticalDepth(kBeam, static_cast<float>(steel), static_cast<float>(water))));
    }
  return sum / (kRays * kRays);
}

/** Compares all affected pixels: RMS at most 1 %, integrated shadow within 0.5 %. */
void expectAccurate(const std::vector<XRayWire>& wires, int pixels)
{
  CArmPose pose;
  pose.pixels = pixels;
  pose.detector_width = 0.2;
  pose.primary_angle = 0.3;
  const XRayGeometry geometry(pose);
  WireProjection projection;
  WireShadow shadow;
  projection.project(
      geometry, wires, [](std::uint32_t /*pixel*/) { return kBeam; }, shadow);
  std::vector<WireEdge> edges;
  for (const XRayWire& wire : wires)
    appendEdges(geometry, wire, edges);
  double squares = 0.0, seen = 0.0, exact = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < shadow.pixels.size(); ++k)
  {
    const int row = static_cast<int>(shadow.pixels[k]) / pixels, column = static_cast<int>(shadow.pixels[k]) % pixels;
    const double reference = bruteForce(geometry, edges, row, column);
    seen += 1.0 - shadow.transmission[k];
    exact += 1.0 - reference;
    if (std::abs(reference - 1.0) < 1e-6)
      continue;
    squares += std::pow(shadow.transmission[k] - reference, 2);
    ++count;
    EXPECT_NEAR(shadow.transmission[k], reference, 0.02) << row << " " << column;
  }
  ASSERT_GT(count, 100U);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(count)), 0.01);
  EXPECT_NEAR(seen / exact, 1.0, 0.005);
}

TEST(WireAccuracy, HoldsForThreeInstrumentsInACurvedVessel)
{
  Points points;
  for (int i = 0; i <= 60; ++i)
    points.emplace_back(0.03 * std::sin(0.03 * i), 0.02 * std::cos(0.045 * i), -0.04 + 1e-3 * i);
  expectAccurate({stack(points, 15, true)}, 256);
}

TEST(WireAccuracy, HoldsAtAJTip)
{
  Points points;
  for (int i = 0; i <= 10; ++i)
    points.emplace_back(-0.01 + 1e-3 * i, 0.0, 0.0);
  for (int i = 1; i <= 20; ++i)
    points.emplace_back(3e-3 * std::sin(i * M_PI / 20.0), 0.0, 3e-3 * (1.0 - std::cos(i * M_PI / 20.0)));
  expectAccurate({stack(points, 12, false)}, 512);
}

TEST(WireAccuracy, HoldsInLoops)
{
  Points points;
  for (int i = 0; i <= 70; ++i)
    points.emplace_back(0.01 * std::cos(0.2 * i), 3e-3 * std::sin(0.2 * i), 0.01 * std::sin(0.2 * i) + 2e-4 * i);
  expectAccurate({stack(points, 12, true)}, 256);
}

TEST(WireAccuracy, HoldsAtCrossingsAndEnds)
{
  Points a, b;
  for (int i = 0; i <= 20; ++i)
  {
    a.emplace_back(-0.01 + 1e-3 * i, 1e-3, 2e-3);
    b.emplace_back(-5e-3 + 5e-4 * i, -0.01, -0.01 + 1e-3 * i);
  }
  expectAccurate({stack(a, 0, false), stack(b, 5, true)}, 512);
}

TEST(WireAccuracy, HoldsForAForeshortenedWire)
{
  Points points;
  for (int i = 0; i <= 40; ++i)
    points.emplace_back(4e-3 * std::sin(0.1 * i), -0.02 + 1e-3 * i, 1e-4 * i);
  expectAccurate({stack(points, 8, true)}, 512);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
