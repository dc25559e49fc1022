#include "contact/wall/facet_forces.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "geometry/mesh_topology.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kCoplanar = 1e-12;  // squared sine, or volume, of normals that count as dependent
constexpr double kLargest = 2.0;     // share of one triangle, relative to the force that is divided

/** Factors of unit normals whose sum is nearest to a force; 0 for one that depends on those before it.
 *  @param count of the normals, 1 to 3 */
Eigen::Vector3d nearestSum(const std::array<Eigen::Vector3d, FacetForces::kMost>& normals, std::size_t count,
                           const Eigen::Vector3d& force)
{
  const Eigen::Vector3d& a = normals[0];
  if (count == 1)
    return {a.dot(force), 0.0, 0.0};
  const Eigen::Vector3d across = a.cross(normals[1]);
  const double squared = across.squaredNorm();
  if (squared < kCoplanar)
    return {a.dot(force), 0.0, 0.0};
  const Eigen::Vector3d& b = normals[1];
  const double volume = count > 2 ? across.dot(normals[2]) : 0.0;
  const double third = volume * volume > kCoplanar ? across.dot(force) / volume : 0.0;
  const Eigen::Vector3d rest = third != 0.0 ? Eigen::Vector3d(force - third * normals[2]) : force;
  return {rest.cross(b).dot(across) / squared, a.cross(rest).dot(across) / squared, third};
}

/** Largest share of a division [N]. */
double largestOf(const FacetForces::Shares& shares)
{
  double force = 0.0;
  for (std::size_t k = 0; k < shares.count; ++k)
    force = std::max(force, shares.share[k].force);
  return force;
}

}  // namespace

FacetForces::FacetForces(const geometry::TriangleMesh& mesh) : neighbour_(mesh.triangles.size(), {-1, -1, -1})
{
  for (const Eigen::Vector3i& corner : mesh.triangles)
  {
    const Eigen::Vector3d& a = mesh.vertices[corner[0]];
    normal_.emplace_back((mesh.vertices[corner[2]] - a).cross(mesh.vertices[corner[1]] - a).normalized());
  }
  const std::vector<geometry::HalfEdge> half_edges = geometry::sortedHalfEdges(mesh);
  for (std::size_t begin = 0; begin < half_edges.size(); begin = geometry::endOfEdge(half_edges, begin))
  {
    if (geometry::endOfEdge(half_edges, begin) != begin + 2)
      continue;
    const geometry::HalfEdge& a = half_edges[begin];
    const geometry::HalfEdge& b = half_edges[begin + 1];
    neighbour_[static_cast<std::size_t>(a.triangle)][static_cast<std::size_t>(a.side)] = b.triangle;
    neighbour_[static_cast<std::size_t>(b.triangle)][static_cast<std::size_t>(b.side)] = a.triangle;
  }
}

/** Adds a triangle to those that carry the force, if it then leaves less of it. Triangles that face each other could
 * carry any force in addition, because their forces cancel out: such a division is left out. */
void FacetForces::add(int triangle, Attempt& attempt) const
{
  Shares shares = attempt.shares;
  if (!isOnMesh(triangle) || shares.count == kMost || attempt.rest <= kBalanced * attempt.force.norm())
    return;
  shares.share[shares.count++].triangle = triangle;
  const double rest = solve(attempt.force, shares);
  if (rest >= (1.0 - kBalanced) * attempt.rest || largestOf(shares) > kLargest * attempt.force.norm())
    return;
  attempt.rest = rest;
  attempt.shares = shares;
}

/** Sets the forces whose sum is nearest to a force; triangles that would pull are left out.
 *  @return magnitude of the rest [N] */
double FacetForces::solve(const Eigen::Vector3d& force, Shares& shares) const
{
  while (shares.count > 0)
  {
    std::array<Eigen::Vector3d, kMost> normals;
    for (std::size_t k = 0; k < shares.count; ++k)
      normals[k] = normal_[static_cast<std::size_t>(shares.share[k].triangle)];
    const Eigen::Vector3d push = nearestSum(normals, shares.count, force);
    std::size_t least = 0;
    for (std::size_t k = 1; k < shares.count; ++k)
      least = push[static_cast<Eigen::Index>(k)] < push[static_cast<Eigen::Index>(least)] ? k : least;
    if (push[static_cast<Eigen::Index>(least)] >= 0.0)
    {
      Eigen::Vector3d rest = force;
      for (std::size_t k = 0; k < shares.count; ++k)
      {
        shares.share[k].force = push[static_cast<Eigen::Index>(k)];
        rest -= shares.share[k].force * normals[k];
      }
      return rest.norm();
    }
    const auto pulls = shares.share.begin() + static_cast<std::ptrdiff_t>(least);
    std::copy(pulls + 1, shares.share.begin() + static_cast<std::ptrdiff_t>(shares.count), pulls);
    --shares.count;
  }
  return force.norm();
}

}  // namespace endovascular_sim::contact
