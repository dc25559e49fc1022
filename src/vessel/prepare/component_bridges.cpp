#include "vessel/prepare/component_bridges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/mesh_distance.h"
#include "geometry/mesh_topology.h"
#include "vessel/centreline/medial_spheres.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Spacing of the component's medial spheres, as for the centreline. */
constexpr double kSphereSpacing = 0.6;
/** Edges of a bridge's cross-section. */
constexpr int kSides = 32;

}  // namespace

std::vector<geometry::TriangleMesh> splitComponents(const geometry::TriangleMesh& mesh)
{
  const std::vector<int> component = geometry::triangleComponents(mesh, geometry::sortedHalfEdges(mesh));
  std::map<int, geometry::TriangleMesh> by_component;
  // A vertex that is shared by touching components is duplicated for each of them.
  std::map<std::pair<int, int>, int> shared;
  std::vector<std::pair<int, int>> index(mesh.vertices.size(), {-1, -1});
  for (std::size_t t = 0; t < component.size(); ++t)
  {
    geometry::TriangleMesh& piece = by_component[component[t]];
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k)
    {
      const auto v = static_cast<std::size_t>(mesh.triangles[t][k]);
      if (index[v].first < 0)
      {
        index[v] = {component[t], static_cast<int>(piece.vertices.size())};
        piece.vertices.push_back(mesh.vertices[v]);
      }
      triangle[k] = index[v].second;
      if (index[v].first == component[t])
        continue;
      const auto [entry, is_new] =
          shared.try_emplace({component[t], mesh.triangles[t][k]}, static_cast<int>(piece.vertices.size()));
      if (is_new)
        piece.vertices.push_back(mesh.vertices[v]);
      triangle[k] = entry->second;
    }
    piece.triangles.push_back(triangle);
  }
  std::vector<std::pair<double, geometry::TriangleMesh>> pieces;
  for (auto& [key, piece] : by_component)
  {
    const double volume = piece.signedVolume();
    pieces.emplace_back(volume, std::move(piece));
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<geometry::TriangleMesh> result;
  result.reserve(pieces.size());
  for (auto& [volume, piece] : pieces)
    result.push_back(std::move(piece));
  return result;
}

Gap findGap(const geometry::TriangleMesh& piece, const geometry::TriangleMesh& other)
{
  const geometry::MeshDistance wall(piece);
  const geometry::MeshDistance goal(other);
  Gap best;
  best.width = 1e300;
  for (const MedialSphere& sphere : thinSpheres(medialSpheres(piece, wall), kSphereSpacing))
  {
    const geometry::ClosestPoint closest = goal.closest(sphere.centre, best.width + sphere.radius);
    if (closest.triangle >= 0 && closest.distance - sphere.radius < best.width)
      best = {sphere.centre, closest.point, closest.distance - sphere.radius, sphere.radius};
  }
  if (best.radius > 0.0)
    return best;
  for (const Eigen::Vector3d& v : piece.vertices)
  {
    const geometry::ClosestPoint closest = goal.closest(v, best.width);
    if (closest.triangle >= 0 && closest.distance < best.width)
      best = {v, closest.point, closest.distance, 0.0};
  }
  return best;
}

geometry::TriangleMesh bridgeMesh(const Gap& gap)
{
  const Eigen::Vector3d along = (gap.to - gap.from).normalized();
  const Eigen::Vector3d u = along.unitOrthogonal();
  const Eigen::Vector3d w = along.cross(u);
  geometry::TriangleMesh tube;
  tube.vertices = {gap.from, gap.to + gap.radius * along};
  for (int k = 0; k < kSides; ++k)
  {
    const double angle = 2.0 * M_PI * k / kSides;
    const Eigen::Vector3d out = gap.radius * (std::cos(angle) * u + std::sin(angle) * w);
    tube.vertices.emplace_back(tube.vertices[0] + out);
    tube.vertices.emplace_back(tube.vertices[1] + out);
    const int a = 2 + 2 * k;
    const int b = 2 + 2 * ((k + 1) % kSides);
    for (const Eigen::Vector3i& t : {Eigen::Vector3i(0, b, a), Eigen::Vector3i(a, b, b + 1),
                                     Eigen::Vector3i(a, b + 1, a + 1), Eigen::Vector3i(1, a + 1, b + 1)})
      tube.triangles.push_back(t);
  }
  return tube;
}

void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& more)
{
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Eigen::Vector3i& t : more.triangles)
    mesh.triangles.emplace_back(t.array() + offset);
}

}  // namespace endovascular_sim::vessel
