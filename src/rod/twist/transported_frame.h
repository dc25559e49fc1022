#pragma once

#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::rod
{

/** Bishop frame that is transported from the hold of the twist along the edges. */
struct TransportedFrame
{
  Eigen::Vector3d tangent, director;  ///< unit, ⟂

  /** Moves to the tangent of the next edge, without turning about it. */
  void moveTo(const Eigen::Vector3d& next)
  {
    director -= (director.dot(next) / (1.0 + tangent.dot(next))) * (tangent + next);
    tangent = next;
  }

  /** Material directions d1 and d2 of an edge whose twist angle is @p angle [rad]. */
  std::pair<Eigen::Vector3d, Eigen::Vector3d> materialAxes(double angle) const
  {
    const Eigen::Vector3d normal = tangent.cross(director);
    return {std::cos(angle) * director + std::sin(angle) * normal,
            std::cos(angle) * normal - std::sin(angle) * director};
  }
};

}  // namespace endovascular_sim::rod
