#include "vessel_prepare/pieces.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "vessel/medial_balls.h"
#include "vessel/mesh_distance.h"
#include "vessel/mesh_topology.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Thins the piece's inscribed balls as the centreline's do. */
constexpr double kBallSpacing = 0.6;
/** Of a bridge's wall, and of a ball's equator. */
constexpr int kSides = 32;

}  // namespace

std::vector<TriangleMesh> separatePieces(const TriangleMesh& mesh)
{
  const std::vector<int> component = triangleComponents(mesh, sortedEdgeUses(mesh));
  std::map<int, TriangleMesh> by_component;
  // A vertex belongs to one piece only, unless sheets touch in it: then each gets its own copy.
  std::map<std::pair<int, int>, int> shared;
  std::vector<std::pair<int, int>> index(mesh.vertices.size(), {-1, -1});
  for (std::size_t t = 0; t < component.size(); ++t)
  {
    TriangleMesh& piece = by_component[component[t]];
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
  std::vector<std::pair<double, TriangleMesh>> pieces;
  for (auto& [key, piece] : by_component)
  {
    const double volume = piece.signedVolume();
    pieces.emplace_back(volume, std::move(piece));
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<TriangleMesh> result;
  for (auto& [volume, piece] : pieces)
    result.push_back(std::move(piece));
  return result;
}

Gap findGap(const TriangleMesh& piece, const TriangleMesh& other)
{
  const MeshDistance wall(piece);
  const MeshDistance goal(other);
  Gap best;
  best.width = 1e300;
  for (const MedialBall& ball : thinBalls(medialBalls(piece, wall), kBallSpacing))
  {
    const ClosestPoint closest = goal.closest(ball.centre, best.width + ball.radius);
    if (closest.triangle >= 0 && closest.distance - ball.radius < best.width)
      best = {ball.centre, closest.point, closest.distance - ball.radius, ball.radius};
  }
  if (best.radius > 0.0)
    return best;
  for (const Eigen::Vector3d& v : piece.vertices)
  {
    const ClosestPoint closest = goal.closest(v, best.width);
    if (closest.triangle >= 0 && closest.distance < best.width)
      best = {v, closest.point, closest.distance, 0.0};
  }
  return best;
}

TriangleMesh bridgeOver(const Gap& gap)
{
  const Eigen::Vector3d along = (gap.to - gap.from).normalized();
  const Eigen::Vector3d u = along.unitOrthogonal();
  const Eigen::Vector3d w = along.cross(u);
  TriangleMesh tube;
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

TriangleMesh ballMesh(const Plug& plug)
{
  TriangleMesh ball;
  const auto add = [&](double polar, double azimuth)
  {
    ball.vertices.emplace_back(plug.centre + plug.radius * Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                                                           std::sin(polar) * std::sin(azimuth),
                                                                           std::cos(polar)));
  };
  add(0.0, 0.0);
  add(M_PI, 0.0);
  const int rows = kSides / 2 - 1;
  for (int j = 0; j < rows; ++j)
    for (int k = 0; k < kSides; ++k)
      add(M_PI * (j + 1) / (rows + 1), 2.0 * M_PI * k / kSides);
  const auto at = [](int j, int k) { return 2 + j * kSides + k % kSides; };
  for (int k = 0; k < kSides; ++k)
  {
    ball.triangles.emplace_back(0, at(0, k), at(0, k + 1));
    ball.triangles.emplace_back(1, at(rows - 1, k + 1), at(rows - 1, k));
    for (int j = 0; j + 1 < rows; ++j)
    {
      ball.triangles.emplace_back(at(j, k), at(j + 1, k), at(j + 1, k + 1));
      ball.triangles.emplace_back(at(j, k), at(j + 1, k + 1), at(j, k + 1));
    }
  }
  return ball;
}

void append(TriangleMesh& mesh, const TriangleMesh& more)
{
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Eigen::Vector3i& t : more.triangles)
    mesh.triangles.emplace_back(t.array() + offset);
}

}  // namespace endovascular_sim::vessel
