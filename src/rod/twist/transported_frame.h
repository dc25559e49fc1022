#pragma once

#include <Eigen/Core>

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
};

}  // namespace endovascular_sim::rod
