#include "vessel/prepare/pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "common/error.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface_samples.h"
#include "geometry/vertex_normals.h"
#include "vessel/centreline/medial_spheres.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Thins the piece's inscribed balls as the centreline's do. */
constexpr double kBallSpacing = 0.6;
/** Of a bridge's wall, and of a disc's rim. */
constexpr int kSides = 32;
/** A lid's plane is the one of this many in which the lumen is smallest. */
constexpr int kLooks = 600;
constexpr int kTrialEdges = 24;
constexpr int kRimEdges = 96;
/** The way out is where one sees farthest, up to this many radii. */
constexpr double kSight = 6.0;
/** Walls are kept below a lid as far as this many depths. */
constexpr double kBelowLid = 6.0;
/** The parts of a wall that are told apart are as long as this many depths. */
constexpr double kPartLength = 2.0;

/** One of kLooks directions that are spread evenly over the sphere: a spiral with the golden angle. */
Eigen::Vector3d spreadDirection(int k)
{
  const double angle = M_PI * (3.0 - std::sqrt(5.0)) * k;
  const double z = 1.0 - (2.0 * k + 1.0) / kLooks;
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

Eigen::Vector3d around(const Eigen::Vector3d& axis, int k, int count)
{
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const double angle = 2.0 * M_PI * k / count;
  return std::cos(angle) * u + std::sin(angle) * axis.cross(u);
}

/** To the wall in a plane, at most the plug's radius [m]. */
std::vector<double> reaches(const Plug& plug, const Eigen::Vector3d& normal, const geometry::MeshDistance& walls,
                            int count)
{
  std::vector<double> result;
  for (int k = 0; k < count; ++k)
  {
    const double hit = walls.rayHit(plug.centre, around(normal, k, count));
    result.push_back(hit < 0.0 ? plug.radius : std::min(hit, plug.radius));
  }
  return result;
}

}  // namespace

std::vector<geometry::TriangleMesh> separatePieces(const geometry::TriangleMesh& mesh)
{
  const std::vector<int> component = geometry::triangleComponents(mesh, geometry::sortedEdgeUses(mesh));
  std::map<int, geometry::TriangleMesh> by_component;
  // A vertex belongs to one piece only, unless sheets touch in it: then each gets its own copy.
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
  for (const MedialSphere& ball : thinBalls(medialBalls(piece, wall), kBallSpacing))
  {
    const geometry::ClosestPoint closest = goal.closest(ball.centre, best.width + ball.radius);
    if (closest.triangle >= 0 && closest.distance - ball.radius < best.width)
      best = {ball.centre, closest.point, closest.distance - ball.radius, ball.radius};
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

geometry::TriangleMesh bridgeOver(const Gap& gap)
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

Disc discOver(const Plug& plug, const geometry::MeshDistance& walls, double overlap, const std::string& source)
{
  Disc disc;
  disc.centre = plug.centre;
  double smallest = 1e300;
  Eigen::Vector3d free = Eigen::Vector3d::Zero();
  for (int k = 0; k < kLooks; ++k)
  {
    const Eigen::Vector3d normal = spreadDirection(k);
    const double hit = walls.rayHit(plug.centre, normal);
    free += (hit < 0.0 ? kSight * plug.radius : std::min(hit, kSight * plug.radius)) * normal;
    double size = 0.0;
    for (double reach : reaches(plug, normal, walls, kTrialEdges))
      size += reach < plug.radius ? reach * reach : 1e3 * plug.radius * plug.radius;
    if (size >= smallest)
      continue;
    smallest = size;
    disc.out = normal;
  }
  if (free.dot(disc.out) < 0.0)
    disc.out = -disc.out;
  const std::vector<double> reach = reaches(plug, disc.out, walls, kRimEdges);
  disc.reach = *std::max_element(reach.begin(), reach.end());
  if (disc.reach >= plug.radius)
    throw InputError(source, "--plug",
                     "at " + formatPlace(plug.centre) + " finds no wall all around within its radius of " +
                         std::to_string(1e3 * plug.radius) +
                         " mm; give a place in the lumen, in metres, or a larger radius");
  disc.mesh.vertices.push_back(plug.centre);
  for (int k = 0; k < kRimEdges; ++k)
  {
    disc.mesh.vertices.emplace_back(plug.centre +
                                    (reach[static_cast<std::size_t>(k)] + overlap) * around(disc.out, k, kRimEdges));
    disc.mesh.triangles.emplace_back(0, 1 + k, 1 + (k + 1) % kRimEdges);
  }
  return disc;
}

geometry::TriangleMesh hollowWalls(const geometry::TriangleMesh& soup, const geometry::TriangleMesh& outside,
                                   double depth, const std::vector<Disc>& discs)
{
  const geometry::SidedMesh side(outside);
  const auto beside = [&](const Eigen::Vector3d& p, const Disc& disc)
  {
    const Eigen::Vector3d from = p - disc.centre;
    const double height = from.dot(disc.out);
    return height < 0.0 && height > -kBelowLid * depth && (from - height * disc.out).norm() < disc.reach + depth;
  };
  const auto keeps = [&](const Eigen::Vector3d& p)
  {
    return side.at(p) < -depth ||
           std::any_of(discs.begin(), discs.end(), [&](const Disc& disc) { return beside(p, disc); });
  };
  geometry::TriangleMesh kept;
  for (const Eigen::Vector3i& whole : soup.triangles)
  {
    const auto corner = [&](int k) { return soup.vertices[static_cast<std::size_t>(whole[k])]; };
    for (const std::array<Eigen::Vector3d, 3>& part :
         geometry::cutTriangle({corner(0), corner(1), corner(2)}, kPartLength * depth))
    {
      if (!keeps((part[0] + part[1] + part[2]) / 3.0))
        continue;
      const int first = static_cast<int>(kept.vertices.size());
      kept.vertices.insert(kept.vertices.end(), part.begin(), part.end());
      kept.triangles.emplace_back(first, first + 1, first + 2);
    }
  }
  return kept;
}

void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& more)
{
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Eigen::Vector3i& t : more.triangles)
    mesh.triangles.emplace_back(t.array() + offset);
}

}  // namespace endovascular_sim::vessel
