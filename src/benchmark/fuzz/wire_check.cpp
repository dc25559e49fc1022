#include "benchmark/fuzz/wire_check.h"

#include <algorithm>
#include <cmath>

#include "geometry/closest_point_on_triangle.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kFloor = 20e-6;     // depth below which edges are not resolved [m]
constexpr double kTolerance = 2e-6;  // depth that a bisected edge may hide [m]
constexpr double kShortest = 1e-7;   // length below which an edge is not bisected [m]

}  // namespace

double WireCheck::signedDistance(const Eigen::Vector3d& point) const
{
  const double distance = distance_.closest(point).distance;
  return geometry::windingNumber(mesh_, point) > 0.5 ? distance : -distance;
}

double WireCheck::bruteSignedDistance(const Eigen::Vector3d& point) const
{
  double squared = 1e300;
  for (const Eigen::Vector3i& corners : mesh_.triangles)
    squared =
        std::min(squared, (geometry::closestPointOnTriangle(point, mesh_.vertices[corners[0]],
                                                            mesh_.vertices[corners[1]], mesh_.vertices[corners[2]])
                               .point -
                           point)
                              .squaredNorm());
  return geometry::windingNumber(mesh_, point) > 0.5 ? std::sqrt(squared) : -std::sqrt(squared);
}

void WireCheck::record(const Edge& edge, double t, double signed_distance)
{
  const double radius = (1.0 - t) * edge.begin->radius + t * edge.end->radius;
  const double allowance = std::max(edge.begin->allowance, edge.end->allowance);
  finding_.outside = finding_.outside || signed_distance < 0.0;
  const double depth = radius - signed_distance - allowance;
  if (depth <= finding_.depth)
    return;
  finding_.depth = depth;
  finding_.edge = edge.index;
  finding_.parameter = t;
}

/** Checks a part of an edge with known signed distance of its first end.
 *  @param distance1 unsigned distance of its second end
 *  @return signed distance of its second end */
double WireCheck::walk(const Edge& edge, double t0, double signed0, double t1, double distance1)
{
  const double length = (t1 - t0) * edge.length;
  const Eigen::Vector3d end = (1.0 - t1) * edge.begin->position + t1 * edge.end->position;
  // The clearance spheres of both ends cover the part, so both ends lie on the same side of the wall.
  const bool covered = length < std::abs(signed0) + distance1;
  double signed1 = std::copysign(distance1, signed0);
  bool bisect = !covered;
  if (covered)
  {
    const double least = 0.5 * (signed0 + signed1 - length);
    const double radius = std::max(edge.begin->radius, edge.end->radius);
    const double allowance = std::max(edge.begin->allowance, edge.end->allowance);
    bisect = radius - allowance - least > std::max(kFloor, finding_.depth) + kTolerance;
  }
  if (bisect && length > kShortest)
  {
    const double middle = 0.5 * (t0 + t1);
    const Eigen::Vector3d centre = (1.0 - middle) * edge.begin->position + middle * edge.end->position;
    const double signed_middle = walk(edge, t0, signed0, middle, distance_.closest(centre).distance);
    return walk(edge, middle, signed_middle, t1, distance1);
  }
  if (!covered)
    signed1 = geometry::windingNumber(mesh_, end) > 0.5 ? distance1 : -distance1;
  record(edge, t1, signed1);
  return signed1;
}

WireFinding WireCheck::check(const std::vector<CheckedNode>& nodes)
{
  finding_ = WireFinding();
  for (const CheckedNode& node : nodes)
    finding_.finite = finding_.finite && node.position.allFinite();
  if (!finding_.finite || nodes.empty())
    return finding_;
  double before = signedDistance(nodes.front().position);
  const Edge first{&nodes.front(), &nodes.front(), 0.0, 0};
  record(first, 0.0, before);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
  {
    const Edge edge{&nodes[i], &nodes[i + 1], (nodes[i + 1].position - nodes[i].position).norm(), static_cast<int>(i)};
    before = walk(edge, 0.0, before, 1.0, distance_.closest(nodes[i + 1].position).distance);
  }
  return finding_;
}

}  // namespace endovascular_sim::benchmark
