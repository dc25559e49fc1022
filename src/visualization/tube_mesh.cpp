#include "visualization/tube_mesh.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/units.h"

namespace endovascular_sim::visualization
{

namespace
{

using units::kPi;
constexpr double kCoinciding = 1e-9;  // distance below which adjacent nodes count as coinciding [m]

/** Tangents at the nodes: bisectors of the adjacent edges. */
std::vector<Eigen::Vector3d> nodeTangents(const std::vector<Eigen::Vector3d>& nodes)
{
  std::vector<Eigen::Vector3d> tangents(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const Eigen::Vector3d before = i > 0 ? (nodes[i] - nodes[i - 1]).normalized() : Eigen::Vector3d::Zero();
    const Eigen::Vector3d after =
        i + 1 < nodes.size() ? (nodes[i + 1] - nodes[i]).normalized() : Eigen::Vector3d::Zero();
    const Eigen::Vector3d sum = before + after;
    // At a reversal of the curve the bisector vanishes. The incoming edge then gives the tangent.
    tangents[i] = sum.norm() > 1e-6 ? Eigen::Vector3d(sum.normalized()) : before;
  }
  return tangents;
}

/** Arbitrary unit vector normal to @p tangent. */
Eigen::Vector3d anyNormal(const Eigen::Vector3d& tangent)
{
  Eigen::Index smallest = 0;
  tangent.cwiseAbs().minCoeff(&smallest);
  return tangent.cross(Eigen::Vector3d::Unit(smallest)).normalized();
}

/** Indices of the finite nodes that do not coincide with the previous one. */
std::vector<std::size_t> distinctNodes(const std::vector<Eigen::Vector3d>& nodes)
{
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].allFinite() && (kept.empty() || (nodes[i] - nodes[kept.back()]).norm() > kCoinciding))
      kept.push_back(i);
  return kept;
}

}  // namespace

std::vector<Eigen::Vector3d> transportedNormals(const std::vector<Eigen::Vector3d>& nodes)
{
  const std::vector<Eigen::Vector3d> tangents = nodeTangents(nodes);
  std::vector<Eigen::Vector3d> normals(nodes.size());
  normals[0] = anyNormal(tangents[0]);
  for (std::size_t i = 1; i < nodes.size(); ++i)
  {
    const Eigen::Vector3d& from = tangents[i - 1];
    const Eigen::Vector3d& to = tangents[i];
    // Smallest rotation from one tangent to the next. At a reversal of the curve it is undefined.
    Eigen::Vector3d normal = normals[i - 1];
    if (from.dot(to) > -1.0 + 1e-9)
      normal = Eigen::Quaterniond::FromTwoVectors(from, to) * normal;
    normal -= normal.dot(to) * to;
    normals[i] = normal.norm() > 1e-9 ? Eigen::Vector3d(normal.normalized()) : anyNormal(to);
  }
  return normals;
}

TubeMesh tubeMesh(const std::vector<Eigen::Vector3d>& nodes, const std::vector<double>& radius, int sides, double scale)
{
  TubeMesh mesh;
  const std::vector<std::size_t> kept = distinctNodes(nodes);
  if (kept.size() < 2 || sides < 3 || radius.size() != nodes.size())
    return mesh;

  std::vector<Eigen::Vector3d> centres(kept.size());
  std::transform(kept.begin(), kept.end(), centres.begin(), [&](std::size_t i) { return nodes[i]; });
  const std::vector<Eigen::Vector3d> tangents = nodeTangents(centres);
  const std::vector<Eigen::Vector3d> normals = transportedNormals(centres);
  const auto count = static_cast<std::size_t>(sides);

  const auto corner = [&](std::size_t k, std::size_t side) -> Eigen::Vector3d
  {
    const double angle = 2.0 * kPi * static_cast<double>(side % count) / static_cast<double>(count);
    const Eigen::Vector3d binormal = tangents[k].cross(normals[k]);
    return centres[k] + scale * radius[kept[k]] * (std::cos(angle) * normals[k] + std::sin(angle) * binormal);
  };
  const auto add = [&](const Eigen::Vector3d& point, std::size_t k)
  {
    mesh.corners.push_back(point);
    mesh.node_of_corner.push_back(kept[k]);
  };

  mesh.corners.reserve(6 * count * kept.size());
  mesh.node_of_corner.reserve(6 * count * kept.size());
  for (std::size_t k = 0; k + 1 < kept.size(); ++k)
    for (std::size_t side = 0; side < count; ++side)
    {
      add(corner(k, side), k);
      add(corner(k, side + 1), k);
      add(corner(k + 1, side), k + 1);
      add(corner(k + 1, side), k + 1);
      add(corner(k, side + 1), k);
      add(corner(k + 1, side + 1), k + 1);
    }
  const std::size_t last = kept.size() - 1;
  for (std::size_t side = 0; side < count; ++side)
  {
    add(centres[0], 0);
    add(corner(0, side + 1), 0);
    add(corner(0, side), 0);
    add(centres[last], last);
    add(corner(last, side), last);
    add(corner(last, side + 1), last);
  }
  return mesh;
}

Colour blend(const Colour& a, const Colour& b, float share)
{
  return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green), a.blue + share * (b.blue - a.blue)};
}

Colour forceColour(double force, double full_scale)
{
  const std::array<Colour, 4> stops{
      {{0.75F, 0.78F, 0.82F}, {1.0F, 0.90F, 0.20F}, {1.0F, 0.50F, 0.05F}, {0.85F, 0.05F, 0.05F}}};
  const double ratio = full_scale > 0.0 && std::isfinite(force) ? std::clamp(force / full_scale, 0.0, 1.0) : 0.0;
  const double position = ratio * static_cast<double>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), stops.size() - 2);
  const auto share = static_cast<float>(position - static_cast<double>(below));
  return blend(stops[below], stops[below + 1], share);
}

}  // namespace endovascular_sim::visualization
