#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::contact
{

/** Share of a contact's normal force that one triangle carries along its normal. */
struct FacetForce
{
  int triangle = -1;
  double force = 0.0;  ///< [N]
};

/** Divider of the forces of contacts among the triangles of a wall, so that the forces along the normals add up to the
 *  vector of the contact. Without allocation. */
class FacetForces
{
public:
  static constexpr std::size_t kMost = 3;  ///< forces along three normals make up any force

  /** Forces of one contact. */
  struct Shares
  {
    std::array<FacetForce, kMost> share;
    std::size_t count = 0;
  };

  /** @param mesh with normals out of the lumen */
  explicit FacetForces(const geometry::TriangleMesh& mesh);

  /** Divides a force among few triangles: those that are touched, in the order in which they are given, then their
   *  neighbours, between which an edge of the mesh pushes. No triangle pulls, and none carries more
   *  than twice the force. Where no such forces balance it, the nearest ones are taken.
   *  @param force of the wall on the wire [N]
   *  @param touched triangles, the deepest first; −1: none */
  template <std::size_t N>
  Shares divide(const Eigen::Vector3d& force, const std::array<int, N>& touched) const
  {
    Attempt attempt(force);
    for (int round = 0; round < 2; ++round)  // one that would pull with those before it may push with those after it
      for (const int triangle : touched)
        add(triangle, attempt);
    for (const int triangle : touched)
      if (isOnMesh(triangle))
        for (const int neighbour : neighbour_[static_cast<std::size_t>(triangle)])
          add(neighbour, attempt);
    return attempt.shares;
  }

private:
  /** Division found so far. */
  struct Attempt
  {
    explicit Attempt(const Eigen::Vector3d& sum) : force(sum), rest(sum.norm()) {}

    Eigen::Vector3d force;
    Shares shares;
    double rest;  ///< magnitude of the force that the shares leave [N]
  };

  static constexpr double kBalanced = 1e-6;  ///< tolerated rest of a force

  bool isOnMesh(int triangle) const { return triangle >= 0 && triangle < static_cast<int>(normal_.size()); }
  void add(int triangle, Attempt& attempt) const;
  double solve(const Eigen::Vector3d& force, Shares& shares) const;

  std::vector<Eigen::Vector3d> normal_;        ///< of every triangle, into the lumen
  std::vector<std::array<int, 3>> neighbour_;  ///< over the edges of every triangle; −1: none
};

}  // namespace endovascular_sim::contact
