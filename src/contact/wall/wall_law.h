#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::contact
{

/** Shape of the wall: the facets of the mesh, or the smooth surface through its vertices (SmoothWall). */
enum class WallShape
{
  kFacets,
  kSmooth,
};

/** Shape and mechanical law of the wall: elastic foundation and Coulomb friction. */
struct WallLaw
{
  WallShape shape = WallShape::kFacets;  ///< of a detector's own wall model; a shared model has its own
  double stiffness = std::numeric_limits<double>::infinity();  ///< per length of wire [N/m²]; infinite: rigid
  double friction = 0.0;                                       ///< Coulomb coefficient outside all regions

  /** A ball in which the wall has another friction coefficient. */
  struct FrictionRegion
  {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
    double radius = 0.0;                               ///< [m]
    double friction = 0.0;                             ///< Coulomb coefficient
  };
  std::vector<FrictionRegion> regions;

  /** Coulomb coefficient at a point of the wall. Where regions overlap, the last one in the list applies. */
  double frictionAt(const Eigen::Vector3d& point) const;
};

}  // namespace endovascular_sim::contact
