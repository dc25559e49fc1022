#include "fluoroscopy/projection/wire_edge.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kNearest = 0.02;           // minimum depth of a visible edge, as a fraction of SID
constexpr double kFoldedCosine = 0.05;      // minimum cosine of the bend at a mitre joint
constexpr double kStraight = 1e-6;          // tolerance of positions of merged edges [m]
constexpr std::size_t kLongestRun = 64;     // largest number of merged edges; the cost of the search is quadratic
constexpr double kStraightPixels = 0.05;    // tolerance of the straight continuation [pixel]
constexpr double kStraightRadius = 0.02;    // the same relative to the radius; the larger one counts
constexpr std::size_t kLongestSearch = 16;  // edges of the straight continuation to either side

/** Normal of the clipping plane of an edge towards its neighbour: the bisecting plane, or the plane normal to the edge
 *  at a sharp bend. */
Eigen::Vector3d mitre(const Eigen::Vector3d& own, const Eigen::Vector3d& other)
{
  return own.dot(other) > kFoldedCosine ? (own + other).normalized() : own;
}

/** Last node of the straight cylinder that begins at @p first. Merging edges saves their joints. */
std::size_t endOfStraight(const XRayWire& wire, std::size_t first)
{
  std::size_t end = first + 1;
  const auto straightTo = [&wire, first](std::size_t last)
  {
    const Eigen::Vector3d& from = wire.nodes[first];
    const Eigen::Vector3d chord = wire.nodes[last] - from;
    const double length = chord.norm();
    double reached = 0.0;
    for (std::size_t k = first + 1; k < last; ++k)
    {
      const Eigen::Vector3d offset = wire.nodes[k] - from;
      const double along = offset.dot(chord);
      if (!(along >= reached) || !(offset.norm() <= length) || offset.cross(chord).norm() > kStraight * length)
        return false;
      reached = along;
    }
    return wire.edge_profile[last - 1] == wire.edge_profile[first];
  };
  while (end + 1 < wire.nodes.size() && end - first < kLongestRun && straightTo(end + 1))
    ++end;
  return end;
}

/** Length beyond an end of @p edge over which @p next … continue straight. @p step is the direction of the search. */
double continuation(const std::vector<WireEdge>& edges, std::size_t edge, int step, std::size_t first, double tolerance,
                    int& last)
{
  const WireEdge& own = edges[edge];
  const Eigen::Vector3d& origin = step > 0 ? own.end : own.begin;
  double length = 0.0;
  last = static_cast<int>(edge);
  for (std::size_t k = 1; k <= kLongestSearch; ++k)
  {
    const auto other = static_cast<std::ptrdiff_t>(edge) + step * static_cast<std::ptrdiff_t>(k);
    if (other < static_cast<std::ptrdiff_t>(first) || other >= static_cast<std::ptrdiff_t>(edges.size()))
      return length;
    const WireEdge& neighbour = edges[static_cast<std::size_t>(other)];
    const WireEdge& inner = edges[static_cast<std::size_t>(other - step)];
    const bool joined = step > 0 ? neighbour.begin == inner.end : neighbour.end == inner.begin;
    if (!joined || neighbour.profile != own.profile || neighbour.axis.dot(own.axis) < 0.8)
      return length;
    const Eigen::Vector3d& far_end = step > 0 ? neighbour.end : neighbour.begin;
    const Eigen::Vector3d offset = far_end - origin;
    const double deviation = (offset - offset.dot(own.axis) * own.axis).norm();
    last = static_cast<int>(other);
    if (deviation > tolerance)
      return length + neighbour.length * tolerance / deviation;
    length += neighbour.length;
  }
  return length;
}

}  // namespace

WireEdge::WireEdge(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const WireProfile& layers)
  : begin(from),
    end(to),
    axis((to - from).normalized()),
    begin_normal(axis),
    end_normal(axis),
    moment(axis.cross(from)),
    across(from - from.dot(axis) * axis),
    depth(0.5 * (from.z() + to.z())),
    radius(0.0),
    length((to - from).norm()),
    profile(&layers)
{
  for (const WireLayer& layer : layers)
    radius = std::max(radius, layer.radius);
}

double WireEdge::mitreDepth(const Eigen::Vector3d& normal) const
{
  const double cosine = normal.dot(axis);
  return radius * std::sqrt(std::max(0.0, 1.0 / (cosine * cosine) - 1.0));
}

void appendEdges(const XRayGeometry& geometry, const XRayWire& wire, std::vector<WireEdge>& edges)
{
  const double nearest = kNearest * geometry.pose().source_to_detector;
  const double farthest = geometry.pose().source_to_detector;
  const auto isVisible = [&](double z, double radius)  // mitre joints extend the axis by less than r
  { return z >= nearest + 2.0 * radius && z <= farthest; };
  std::vector<WireEdge> chain;
  std::size_t next = 0;
  for (std::size_t j = 0; j + 1 < wire.nodes.size(); j = next)
  {
    next = endOfStraight(wire, j);
    const WireProfile& profile = wire.profiles[wire.edge_profile[j]];
    const Eigen::Vector3d begin = geometry.toOptical(wire.nodes[j]);
    double radius = 0.0;
    for (const WireLayer& layer : profile)
      radius = std::max(radius, layer.radius);
    // Invisible edges are omitted one by one, so that they are not merged.
    if (!isVisible(begin.z(), radius) || !isVisible(geometry.toOptical(wire.nodes[next]).z(), radius))
      next = j + 1;
    const Eigen::Vector3d end = geometry.toOptical(wire.nodes[next]);
    if (begin == end)
      continue;
    WireEdge edge(begin, end, profile);
    if (!chain.empty())
    {
      edge.begin_normal = mitre(edge.axis, chain.back().axis);
      chain.back().end_normal = mitre(chain.back().axis, edge.axis);
    }
    chain.push_back(edge);
  }
  const std::size_t first = edges.size();
  for (const WireEdge& edge : chain)
    if (edge.radius > 0.0 && isVisible(edge.begin.z(), edge.radius) && isVisible(edge.end.z(), edge.radius))
      edges.push_back(edge);
  for (std::size_t k = first; k < edges.size(); ++k)
  {
    WireEdge& edge = edges[k];
    const double tolerance =
        std::max(kStraightPixels * edge.depth / geometry.focalLength(), kStraightRadius * edge.radius);
    edge.straight_before = continuation(edges, k, -1, first, tolerance, edge.first_straight);
    edge.straight_after = continuation(edges, k, 1, first, tolerance, edge.last_straight);
  }
}

}  // namespace endovascular_sim::fluoroscopy
