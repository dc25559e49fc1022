#include "vessel/repair/mesh_target.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include <Eigen/Geometry>

#include "geometry/vertex_normals.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Approximate number of vertices at which the radius is measured. Other vertices take the radius of the nearest one
 *  along edges. */
constexpr std::size_t kProbes = 60000;
/** Gradation: largest growth of the edge length per distance along the wall. */
constexpr double kGradation = 0.25;
constexpr int kRadiusSweeps = 10;
/** Offset of a ray's origin below the wall, so that the ray does not hit its own facets [m]. */
constexpr double kRayOffset = 1e-6;

std::vector<std::vector<int>> edgeNeighbours(const geometry::TriangleMesh& mesh)
{
  std::vector<std::vector<int>> neighbours(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      neighbours[static_cast<std::size_t>(t[k])].push_back(t[(k + 1) % 3]);
  return neighbours;
}

}  // namespace

MeshTarget::MeshTarget(const geometry::TriangleMesh& mesh, const SizingRule& rule)
  : mesh_(mesh),
    rule_(rule),
    distance_(mesh),
    neighbours_(edgeNeighbours(mesh)),
    normal_(geometry::vertexNormals(mesh)),
    radius_(mesh.vertices.size())
{
  findRadii();
  edge_length_.reserve(radius_.size());
  for (double radius : radius_)
  {
    const double by_circumference = 2.0 * M_PI * radius / rule.facets_around;
    const double by_deviation = std::sqrt(8.0 * radius * rule.deviation);
    edge_length_.push_back(std::clamp(std::min(by_circumference, by_deviation), rule.shortest, rule.longest));
  }
  grade();
}

void MeshTarget::grade()
{
  using Entry = std::pair<double, int>;
  const auto boundAt = [this](std::size_t v, std::size_t n)
  { return edge_length_[v] + kGradation * (mesh_.vertices[n] - mesh_.vertices[v]).norm(); };
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (std::size_t v = 0; v < edge_length_.size(); ++v)  // vertices that bound a neighbour
    if (std::any_of(neighbours_[v].begin(), neighbours_[v].end(),
                    [&](int n)
                    { return boundAt(v, static_cast<std::size_t>(n)) < edge_length_[static_cast<std::size_t>(n)]; }))
      open.emplace(edge_length_[v], static_cast<int>(v));
  while (!open.empty())
  {
    const auto [edge_length, vertex] = open.top();
    open.pop();
    const auto v = static_cast<std::size_t>(vertex);
    if (edge_length > edge_length_[v])
      continue;
    for (int next : neighbours_[v])
    {
      const auto n = static_cast<std::size_t>(next);
      const double bound = boundAt(v, n);
      if (bound >= edge_length_[n])
        continue;
      edge_length_[n] = bound;
      open.emplace(bound, next);
    }
  }
}

int MeshTarget::refine(const geometry::MeshDistance& result, double limit)
{
  std::vector<std::size_t> far;
  for (std::size_t v = 0; v < edge_length_.size(); ++v)
    if (edge_length_[v] > rule_.shortest && result.closest(mesh_.vertices[v], limit).triangle < 0)
      far.push_back(v);
  for (std::size_t v : far)
    edge_length_[v] = std::max(rule_.shortest, 0.5 * edge_length_[v]);
  grade();
  return static_cast<int>(far.size());
}

void MeshTarget::findRadii()
{
  std::vector<bool> known(radius_.size(), false);
  std::queue<int> open;
  const std::size_t stride = radius_.size() / kProbes + 1;
  for (std::size_t v = 0; v < radius_.size(); v += stride)
  {
    const double chord = distance_.rayHit(mesh_.vertices[v] - kRayOffset * normal_[v], -normal_[v]);
    if (!(chord > 0.0))
      continue;
    radius_[v] = 0.5 * (chord + kRayOffset);
    known[v] = true;
    open.push(static_cast<int>(v));
  }
  for (; !open.empty(); open.pop())
    for (int next : neighbours_[static_cast<std::size_t>(open.front())])
      if (!known[static_cast<std::size_t>(next)])
      {
        known[static_cast<std::size_t>(next)] = true;
        radius_[static_cast<std::size_t>(next)] = radius_[static_cast<std::size_t>(open.front())];
        open.push(next);
      }
  for (int sweep = 0; sweep < kRadiusSweeps; ++sweep)
  {
    const std::vector<double> rough = radius_;
    for (std::size_t v = 0; v < radius_.size(); ++v)
    {
      double sum = rough[v];
      for (int next : neighbours_[v])
        sum += rough[static_cast<std::size_t>(next)];
      radius_[v] = sum / static_cast<double>(neighbours_[v].size() + 1);
    }
  }
}

TargetPoint MeshTarget::project(const Eigen::Vector3d& p) const
{
  const geometry::ClosestPoint closest = distance_.closest(p);
  const Eigen::Vector3i& t = mesh_.triangles[static_cast<std::size_t>(closest.triangle)];
  const Eigen::Vector3d weights = geometry::barycentric(mesh_, closest);
  TargetPoint result{closest.point, geometry::normalAt(mesh_, normal_, closest), 0.0};
  for (int k = 0; k < 3; ++k)
    result.edge_length += weights[k] * edge_length_[static_cast<std::size_t>(t[k])];
  return result;
}

double MeshTarget::radiusAt(const Eigen::Vector3d& p) const
{
  const geometry::ClosestPoint closest = distance_.closest(p);
  const Eigen::Vector3i& t = mesh_.triangles[static_cast<std::size_t>(closest.triangle)];
  const Eigen::Vector3d weights = geometry::barycentric(mesh_, closest);
  double radius = 0.0;
  for (int k = 0; k < 3; ++k)
    radius += weights[k] * radius_[static_cast<std::size_t>(t[k])];
  return radius;
}

}  // namespace endovascular_sim::vessel
