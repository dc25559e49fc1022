#include <algorithm>

#include <Eigen/Geometry>

#include "rod/kkt_stepper.h"

// The part of the scheme that deals with held ends: where the distal one is, and the forces on both.

namespace endovascular_sim::rod
{

bool KktStepper::isDistalHeld(int node) const
{
  const int last = rod_.nodes() - 1;
  return (boundary_.distal != EndHold::kFree && node == last) ||
         (boundary_.distal == EndHold::kClamped && node == last - 1);
}

/** From the wire's first direction to that of its clamped distal end. */
Eigen::Matrix3d KktStepper::distalRotation(const State& state)
{
  const double angle = state.distal.tilt.norm();
  if (angle == 0.0)
    return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, state.distal.tilt / angle).toRotationMatrix();
}

/** A clamp acts at the middle of its edge: it moves that point and turns the edge about it. */
void KktStepper::placeDistalEnd(State& state, const EndMotion& motion, double dt)
{
  state.distal = motion;
  if (boundary_.distal == EndHold::kFree)
    return;
  const int last = rod_.nodes() - 1;
  const Eigen::Vector3d place = state.distal_anchor + motion.displacement;
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  if (boundary_.distal == EndHold::kClamped)
    half = (0.5 * rod_.rest_length[last - 1]) * (distalRotation(state) * boundary_.direction);
  for (int i = last; i >= 0 && isDistalHeld(i); --i)
  {
    const Eigen::Vector3d target = i == last ? Eigen::Vector3d(place + half) : Eigen::Vector3d(place - half);
    state.velocity[i] = (target - state.position[i]) / dt;
    state.position[i] = target;
  }
}

/** Force of the wire on what holds a node: what is left of the node's own equation at the solution. */
Eigen::Vector3d KktStepper::forceOnHold(int node, double dt) const
{
  Eigen::Vector3d force;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int line = row(node) + axis;
    double sum = base_rhs_[line];
    for (int k = std::max(0, line - kBandwidth); k <= std::min(base_.size() - 1, line + kBandwidth); ++k)
      sum -= base_.at(std::max(line, k), std::min(line, k)) * rhs_[k];
    force[axis] = sum / (dt * dt);
  }
  return force;
}

/** The force at the hand is taken from the equations of the held nodes, not from an edge's multiplier: in a bent edge
 *  that one holds a part of the bending too. */
void KktStepper::updateEndForces(State& state, double dt) const
{
  const int last = rod_.nodes() - 1;
  state.proximal_force.setZero();
  state.distal_force.setZero();
  for (int i = last; isDistalHeld(i); --i)
    state.distal_force += forceOnHold(i, dt);
  for (int i = first_; i <= last && isPrescribed(i, state) && !isDistalHeld(i); ++i)
    state.proximal_force += forceOnHold(i, dt);
  state.hand_force = -boundary_.direction.dot(state.proximal_force);
}

}  // namespace endovascular_sim::rod
