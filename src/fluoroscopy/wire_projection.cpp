#include "fluoroscopy/wire_projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kSamples = 89;  // Fibonacci numbers F(11), and F(10) for the lattice
constexpr int kLatticeStep = 55;
constexpr double kNearest = 0.02;       // closest approach to the source, as a part of SID
constexpr double kFoldedCosine = 0.05;  // mitres are for bends below 90°
constexpr double kReach = 1.6;  // of a mitred cylinder from its axis, in radii: √2 at a 90° bend, and obliquity
constexpr double kHalfDiagonal = 0.7072;

using Offsets = std::array<Eigen::Vector2d, kSamples>;

/** Samples of a pixel from its centre, as differences (x, y) of rays with z = 1. */
Offsets sampleOffsets(double focal_length)
{
  Offsets offsets;
  for (int i = 0; i < kSamples; ++i)
    offsets[static_cast<std::size_t>(i)] =
        Eigen::Vector2d((i + 0.5) / kSamples - 0.5, 0.5 - ((i * kLatticeStep) % kSamples + 0.5) / kSamples) /
        focal_length;
  return offsets;
}

void check(const XRayWire& wire)
{
  const std::size_t edges = wire.nodes.empty() ? 0 : wire.nodes.size() - 1;
  if (wire.radius.size() != wire.nodes.size() || wire.attenuation.size() != edges)
    throw InputError("wire", "radius, attenuation",
                     "must have one radius per node and one attenuation per edge; there are " +
                         std::to_string(wire.nodes.size()) + " nodes");
  for (std::size_t i = 0; i < wire.nodes.size(); ++i)
    if (!wire.nodes[i].allFinite() || !std::isfinite(wire.radius[i]) || wire.radius[i] < 0.0)
      throw InputError("wire", "node " + std::to_string(i), "must be finite with a radius of at least 0");
}

/** Distance of a point from a segment in the image [pixel]. */
double distance(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  const Eigen::Vector2d ab = b - a;
  const double square = ab.squaredNorm();
  const double along = square > 0.0 ? std::clamp((p - a).dot(ab) / square, 0.0, 1.0) : 0.0;
  return (p - a - along * ab).norm();
}

/** Normal of the plane between edges with directions a and b; both when the wire folds back. */
Eigen::Vector3d mitre(const Eigen::Vector3d& own, const Eigen::Vector3d& other)
{
  return own.dot(other) > kFoldedCosine ? (own + other).normalized() : own;
}

}  // namespace

/** One mitred cylinder in the optical frame. */
struct WireProjection::Edge
{
  Eigen::Vector3d begin, end;                // ends of the axis [m]
  Eigen::Vector3d axis;                      // unit
  Eigen::Vector3d begin_normal, end_normal;  // of the planes that cut it, both along the axis
  double radius;                             // [m]
  double attenuation;                        // [1/m]

  /** Length of the ray t·d inside [m]. */
  double chord(const Eigen::Vector3d& d, const Eigen::Vector3d& moment, const Eigen::Vector3d& across) const
  {
    const double square = d.squaredNorm();
    const double along = d.dot(axis);
    const double a = square - along * along;
    const double h = d.dot(moment);
    const double discriminant = a * radius * radius - h * h;
    if (discriminant <= 0.0 || a <= 1e-12 * square)
      return 0.0;
    const double half = std::sqrt(discriminant) / a;
    const double middle = d.dot(across) / a;
    double t0 = middle - half, t1 = middle + half;
    cut(begin_normal.dot(d), begin_normal.dot(begin), t0, t1);
    cut(-end_normal.dot(d), -end_normal.dot(end), t0, t1);
    return t1 > t0 ? (t1 - t0) * std::sqrt(square) : 0.0;
  }

private:
  /** Keeps the part of [t0, t1] with slope·t ≥ offset. */
  static void cut(double slope, double offset, double& t0, double& t1)
  {
    const bool out0 = slope * t0 < offset, out1 = slope * t1 < offset;
    if (out0 && out1)
      t1 = t0;
    else if (out0)
      t0 = offset / slope;
    else if (out1)
      t1 = offset / slope;
  }
};

float* WireProjection::samplesOf(std::uint32_t pixel)
{
  std::int32_t& slot = slot_[pixel];
  if (slot < 0)
  {
    slot = static_cast<std::int32_t>(pixels_.size());
    pixels_.push_back(pixel);
    optical_depth_.resize(optical_depth_.size() + kSamples, 0.0F);
  }
  return optical_depth_.data() + static_cast<std::size_t>(slot) * kSamples;
}

void WireProjection::addEdge(const XRayGeometry& geometry, const Edge& edge)
{
  const double f = geometry.focalLength(), centre = geometry.centre();
  const Offsets offsets = sampleOffsets(f);
  const auto image = [&](const Eigen::Vector3d& p)
  { return Eigen::Vector2d(centre + f * p.x() / p.z(), centre - f * p.y() / p.z()); };
  const Eigen::Vector2d p0 = image(edge.begin), p1 = image(edge.end);
  const double half_width = geometry.pixels() / (2.0 * f);
  const double obliquity = std::sqrt(1.0 + 2.0 * half_width * half_width);
  const double reach = kReach * obliquity * edge.radius * f / std::min(edge.begin.z(), edge.end.z()) + kHalfDiagonal;
  const double last = geometry.pixels() - 1;
  const auto first_row = static_cast<int>(std::ceil(std::clamp(std::min(p0.y(), p1.y()) - reach, 0.0, last + 1.0)));
  const auto last_row = static_cast<int>(std::floor(std::clamp(std::max(p0.y(), p1.y()) + reach, -1.0, last)));
  const auto first_column = static_cast<int>(std::ceil(std::clamp(std::min(p0.x(), p1.x()) - reach, 0.0, last + 1.0)));
  const auto last_column = static_cast<int>(std::floor(std::clamp(std::max(p0.x(), p1.x()) + reach, -1.0, last)));
  const Eigen::Vector3d moment = edge.axis.cross(edge.begin);
  const Eigen::Vector3d across = edge.begin - edge.begin.dot(edge.axis) * edge.axis;
  for (int row = first_row; row <= last_row; ++row)
    for (int column = first_column; column <= last_column; ++column)
    {
      if (distance({column, row}, p0, p1) > reach)
        continue;
      float* samples = samplesOf(static_cast<std::uint32_t>(row * geometry.pixels() + column));
      const Eigen::Vector3d ray = geometry.ray(column, row);
      for (std::size_t i = 0; i < kSamples; ++i)
        samples[i] += static_cast<float>(
            edge.attenuation * edge.chord({ray.x() + offsets[i].x(), ray.y() + offsets[i].y(), 1.0}, moment, across));
    }
}

void WireProjection::addWire(const XRayGeometry& geometry, const XRayWire& wire)
{
  std::vector<Edge> edges;
  for (std::size_t j = 0; j + 1 < wire.nodes.size(); ++j)
  {
    Edge edge{geometry.toOptical(wire.nodes[j]),
              geometry.toOptical(wire.nodes[j + 1]),
              {},
              {},
              {},
              0.5 * (wire.radius[j] + wire.radius[j + 1]),
              wire.attenuation[j]};
    const double length = (edge.end - edge.begin).norm();
    if (length <= 0.0)
      continue;
    edge.axis = (edge.end - edge.begin) / length;
    edge.begin_normal = edge.end_normal = edge.axis;
    if (!edges.empty())
    {
      edge.begin_normal = mitre(edge.axis, edges.back().axis);
      edges.back().end_normal = mitre(edges.back().axis, edge.axis);
    }
    edges.push_back(edge);
  }
  const double nearest = kNearest * geometry.pose().source_to_detector;
  const double farthest = geometry.pose().source_to_detector;
  for (const Edge& edge : edges)
    if (std::min(edge.begin.z(), edge.end.z()) >= nearest && std::max(edge.begin.z(), edge.end.z()) <= farthest)
      addEdge(geometry, edge);
}

void WireProjection::project(const XRayGeometry& geometry, const std::vector<XRayWire>& wires, WireShadow& shadow)
{
  for (const XRayWire& wire : wires)
    check(wire);
  const auto size = static_cast<std::size_t>(geometry.pixels()) * static_cast<std::size_t>(geometry.pixels());
  if (slot_.size() != size)
    slot_.assign(size, -1);
  pixels_.clear();
  optical_depth_.clear();
  for (const XRayWire& wire : wires)
    addWire(geometry, wire);

  shadow.pixels = pixels_;
  shadow.transmission.resize(pixels_.size());
  for (std::size_t k = 0; k < pixels_.size(); ++k)
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < kSamples; ++i)
      sum += std::exp(-static_cast<double>(optical_depth_[k * kSamples + i]));
    shadow.transmission[k] = sum / kSamples;
    slot_[pixels_[k]] = -1;
  }
}

}  // namespace endovascular_sim::fluoroscopy
