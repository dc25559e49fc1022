#include "fluoroscopy/projection/wire_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fluoroscopy/projection/profile_integral.h"
#include "fluoroscopy/projection/wire_footprint.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kHalfDiagonal = 0.7072;  // half the diagonal of a pixel, rounded up [pixel]
constexpr double kSteepest = 1e-3;        // minimum A/|d|² of the profile integral

/** Position of a pixel's central ray relative to an edge. */
struct Approach
{
  Approach(const WireEdge& edge, const Eigen::Vector3d& ray)
  {
    along = ray.dot(edge.axis);
    const double norm = ray.squaredNorm();
    a = norm - along * along;
    steep = a < kSteepest * norm;
    t = edge.across.dot(ray) / std::max(a, kSteepest * norm);
    const Eigen::Vector3d closest = t * ray;
    after_begin = (closest - edge.begin).dot(edge.begin_normal);
    before_end = (edge.end - closest).dot(edge.end_normal);
  }

  double along, a, t;
  double after_begin, before_end;  ///< distances of the closest point of the ray from the clipping planes [m]
  bool steep;                      ///< the ray is nearly parallel to the axis
};

/** Length along the axis from the closest point of the central ray to the farthest point inside the wire of any ray of
 * the pixel [m]. */
double reachAlongAxis(const WireEdge& edge, const Approach& approach, double half_diagonal)
{
  const double cotangent = std::abs(approach.along) / std::sqrt(approach.a);
  return edge.radius * cotangent + half_diagonal * approach.t * (1.0 + 3.0 * cotangent);
}

}  // namespace

void WireProjection::collect(const XRayGeometry& geometry)
{
  const int n = geometry.pixels();
  entries_.clear();
  pixels_.clear();
  for (std::size_t k = 0; k < edges_.size(); ++k)
  {
    const WireFootprint footprint(geometry, edges_[k]);
    for (int row = footprint.first_row; row <= footprint.last_row; ++row)
    {
      const WireFootprint::Columns columns = footprint.columns(row);
      for (int column = columns.first; column <= columns.last; ++column)
      {
        const auto pixel = static_cast<std::uint32_t>(row * n + column);
        if (head_[pixel] < 0)
          pixels_.push_back(pixel);
        entries_.push_back({static_cast<std::int32_t>(k), head_[pixel]});
        head_[pixel] = static_cast<std::int32_t>(entries_.size()) - 1;
      }
    }
  }
}

/** Edge whose profile applies to the whole pixel; −1 if there is none. */
int WireProjection::edgeOfStraightPart(const Eigen::Vector3d& ray, std::int32_t entry, double half_diagonal) const
{
  int best = -1;
  double best_margin = -std::numeric_limits<double>::infinity(), reach = 0.0;
  double after_begin = 0.0, before_end = 0.0;
  for (std::int32_t e = entry; e >= 0; e = entries_[static_cast<std::size_t>(e)].next)
  {
    const int k = entries_[static_cast<std::size_t>(e)].edge;
    const WireEdge& edge = edges_[static_cast<std::size_t>(k)];
    const Approach approach(edge, ray);
    if (approach.steep)
      return -1;
    const double margin = std::min(approach.after_begin, approach.before_end);
    if (margin <= best_margin)
      continue;
    best = k;
    best_margin = margin;
    reach = reachAlongAxis(edge, approach, half_diagonal);
    after_begin = approach.after_begin;
    before_end = approach.before_end;
  }
  const WireEdge& edge = edges_[static_cast<std::size_t>(best)];
  if (after_begin + edge.straight_before < reach || before_end + edge.straight_after < reach)
    return -1;
  for (std::int32_t e = entry; e >= 0; e = entries_[static_cast<std::size_t>(e)].next)
  {
    const int k = entries_[static_cast<std::size_t>(e)].edge;
    if (k < edge.first_straight || k > edge.last_straight)
      return -1;
  }
  return best;
}

double WireProjection::transmission(const XRayGeometry& geometry, std::uint32_t pixel,
                                    const DeviceCoefficients& coefficients, WireSamples& samples) const
{
  const auto n = static_cast<std::uint32_t>(geometry.pixels());
  const Eigen::Vector3d ray = geometry.ray(pixel % n, pixel / n);
  const std::int32_t entry = head_[pixel];
  const int straight = edgeOfStraightPart(ray, entry, kHalfDiagonal / geometry.focalLength());
  if (straight >= 0)
  {
    const WireEdge& edge = edges_[static_cast<std::size_t>(straight)];
    return profileTransmission(*edge.profile, edge.radius, PixelView(edge, ray, geometry.focalLength()), coefficients);
  }
  samples.clear();
  for (std::int32_t e = entry; e >= 0; e = entries_[static_cast<std::size_t>(e)].next)
    samples.add(edges_[static_cast<std::size_t>(entries_[static_cast<std::size_t>(e)].edge)], ray);
  return samples.transmission(coefficients);
}

void WireProjection::project(const XRayGeometry& geometry, const std::vector<XRayWire>& wires,
                             const Coefficients& coefficients, WireShadow& shadow)
{
  for (const XRayWire& wire : wires)
    checkWire(wire);
  const auto size = static_cast<std::size_t>(geometry.pixels()) * static_cast<std::size_t>(geometry.pixels());
  if (head_.size() != size)
    head_.assign(size, -1);
  edges_.clear();
  for (const XRayWire& wire : wires)
    appendEdges(geometry, wire, edges_);
  collect(geometry);

  WireSamples samples(geometry.focalLength());
  shadow.pixels = pixels_;
  shadow.transmission.resize(pixels_.size());
  for (std::size_t k = 0; k < pixels_.size(); ++k)
    shadow.transmission[k] = transmission(geometry, pixels_[k], coefficients(pixels_[k]), samples);
  for (const std::uint32_t pixel : pixels_)
    head_[pixel] = -1;
}

}  // namespace endovascular_sim::fluoroscopy
