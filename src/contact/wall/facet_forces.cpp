#include "contact/wall/facet_forces.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <Eigen/QR>

#include "geometry/mesh_topology.h"

namespace endovascular_sim::contact
{

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

/** Adds a triangle to those that carry the force, if it then leaves less of it. */
void FacetForces::add(int triangle, Attempt& attempt) const
{
  Shares shares = attempt.shares;
  if (!isOnMesh(triangle) || shares.count == kMost || attempt.rest <= kBalanced * attempt.force.norm())
    return;
  shares.share[shares.count++].triangle = triangle;
  const double rest = solve(attempt.force, shares);
  if (rest >= (1.0 - kBalanced) * attempt.rest)
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
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMost> normals(3, static_cast<Eigen::Index>(shares.count));
    for (std::size_t k = 0; k < shares.count; ++k)
      normals.col(static_cast<Eigen::Index>(k)) = normal_[static_cast<std::size_t>(shares.share[k].triangle)];
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1> push = normals.colPivHouseholderQr().solve(force);
    Eigen::Index least = 0;
    if (push.minCoeff(&least) >= 0.0)
    {
      for (std::size_t k = 0; k < shares.count; ++k)
        shares.share[k].force = push[static_cast<Eigen::Index>(k)];
      return (force - normals * push).norm();
    }
    const auto pulls = shares.share.begin() + least;
    std::copy(pulls + 1, shares.share.begin() + static_cast<std::ptrdiff_t>(shares.count), pulls);
    --shares.count;
  }
  return force.norm();
}

}  // namespace endovascular_sim::contact
