#include "vessel/repair/mesh_sizing.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include <Eigen/Geometry>

#include "geometry/vertex_normals.h"

namespace endovascular_sim::vessel
{
namespace
{

/** The lumen is probed at about this many vertices; the others take the radius of the nearest one over the edges. */
constexpr std::size_t kProbes = 60000;
/** Facets become longer along the wall by at most this fraction of the way. */
constexpr double kSteepestGrowth = 0.25;
constexpr int kRadiusSweeps = 10;
/** The probe starts this far below the wall, so that it does not hit its own facets [m]. */
constexpr double kHair = 1e-6;

std::vector<std::vector<int>> edgeNeighbours(const geometry::TriangleMesh& mesh)
{
  std::vector<std::vector<int>> neighbours(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      neighbours[static_cast<std::size_t>(t[k])].push_back(t[(k + 1) % 3]);
  return neighbours;
}

}  // namespace

MeshSizing::MeshSizing(const geometry::TriangleMesh& mesh, const SizingRule& rule)
  : mesh_(mesh),
    rule_(rule),
    distance_(mesh),
    neighbours_(edgeNeighbours(mesh)),
    normal_(geometry::vertexNormals(mesh)),
    radius_(mesh.vertices.size())
{
  findRadii();
  facet_.reserve(radius_.size());
  for (double radius : radius_)
  {
    const double round = 2.0 * M_PI * radius / rule.facets_around;
    const double flat = std::sqrt(8.0 * radius * rule.deviation);
    facet_.push_back(std::clamp(std::min(round, flat), rule.shortest, rule.longest));
  }
  grade();
}

void MeshSizing::grade()
{
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (std::size_t v = 0; v < facet_.size(); ++v)
    open.emplace(facet_[v], static_cast<int>(v));
  while (!open.empty())
  {
    const auto [facet, vertex] = open.top();
    open.pop();
    const auto v = static_cast<std::size_t>(vertex);
    if (facet > facet_[v])
      continue;
    for (int next : neighbours_[v])
    {
      const auto n = static_cast<std::size_t>(next);
      const double most = facet + kSteepestGrowth * (mesh_.vertices[n] - mesh_.vertices[v]).norm();
      if (most >= facet_[n])
        continue;
      facet_[n] = most;
      open.emplace(most, next);
    }
  }
}

int MeshSizing::refine(const geometry::MeshDistance& made, double limit)
{
  std::vector<std::size_t> far;
  for (std::size_t v = 0; v < facet_.size(); ++v)
    if (facet_[v] > rule_.shortest && made.closest(mesh_.vertices[v], limit).triangle < 0)
      far.push_back(v);
  for (std::size_t v : far)
    facet_[v] = std::max(rule_.shortest, 0.5 * facet_[v]);
  grade();
  return static_cast<int>(far.size());
}

void MeshSizing::findRadii()
{
  std::vector<bool> known(radius_.size(), false);
  std::queue<int> open;
  const std::size_t stride = radius_.size() / kProbes + 1;
  for (std::size_t v = 0; v < radius_.size(); v += stride)
  {
    const double chord = distance_.rayHit(mesh_.vertices[v] - kHair * normal_[v], -normal_[v]);
    if (!(chord > 0.0))
      continue;
    radius_[v] = 0.5 * (chord + kHair);
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

WallPoint MeshSizing::onWall(const Eigen::Vector3d& p) const
{
  const geometry::ClosestPoint closest = distance_.closest(p);
  const Eigen::Vector3i& t = mesh_.triangles[static_cast<std::size_t>(closest.triangle)];
  const Eigen::Vector3d share = geometry::barycentric(mesh_, closest);
  WallPoint result{closest.point, geometry::normalAt(mesh_, normal_, closest), 0.0};
  for (int k = 0; k < 3; ++k)
    result.facet += share[k] * facet_[static_cast<std::size_t>(t[k])];
  return result;
}

double MeshSizing::radiusAt(const Eigen::Vector3d& p) const
{
  const geometry::ClosestPoint closest = distance_.closest(p);
  const Eigen::Vector3i& t = mesh_.triangles[static_cast<std::size_t>(closest.triangle)];
  const Eigen::Vector3d share = geometry::barycentric(mesh_, closest);
  double radius = 0.0;
  for (int k = 0; k < 3; ++k)
    radius += share[k] * radius_[static_cast<std::size_t>(t[k])];
  return radius;
}

}  // namespace endovascular_sim::vessel
