#include <Eigen/Geometry>

#include "rod/boundary/hand_force_parts.h"
#include "rod/boundary/reaction_forces.h"
#include "rod/kkt/kkt_stepper.h"

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

/** Force of the wire on what holds a node: what is left of the node's own equation at the solution [N]. */
Eigen::Vector3d KktStepper::forceOnHold(int node, double dt) const
{
  return remainder(base_, Eigen::Vector3d(base_rhs_.data() + row(node)), rhs_, row(node)) / (dt * dt);
}

void KktStepper::updateEndForces(State& state, double dt) const
{
  const int free = firstFreeNode(state);
  rod::updateEndForces(
      state, boundary_, [this, free](int node) { return node < free || isDistalHeld(node); },
      [this, dt](int node) { return forceOnHold(node, dt); });
}

/** Bending takes what the others leave: elastic forces, the wall's normal ones and the guide's. */
void KktStepper::updateHandParts(State& state, double dt)
{
  const int n = rod_.nodes();
  slideAlongItself(state.position, motion_, first_, firstFreeNode(state) - 1, boundary_.direction, slide_);
  const double inverse = 1.0 / dt;
  const std::vector<MassSlide>* mass_slide = massSlide();
  const bool heavy = !environment_.gravity.isZero(0.0);
  HandForceParts parts;
  parts.friction = parts.inertia = parts.drag = parts.load = 0.0;
  for (int i = first_; i < n; ++i)
  {
    const double travel = slide_[i].dot(state.position[i] - begin_[i]);
    parts.inertia += rod_.mass[i] * inverse * (inverse * travel - slide_[i].dot(state.velocity[i]));
    parts.drag += resistance_[i] * inverse * inverse * travel;
    if (mass_slide != nullptr)
    {
      parts.inertia += rod_.mass[i] * inverse * inverse * slide_[i].dot((*mass_slide)[i].gained);
      parts.drag += inverse * inverse * slide_[i].dot(resisted_[i]);
    }
    if (heavy)
      parts.load -= heavyMass(i) * slide_[i].dot(environment_.gravity);
  }
  for (const NodalForce& force : last_input_.forces)
    if (force.node >= first_)
      parts.load -= slide_[force.node].dot(force.force);
  parts.load += slide_.back().dot(state.distal_force);
  for (std::size_t k = 0; k < friction_.count(); ++k)
  {
    const WallFriction::Term& term = friction_.term(k);
    parts.friction += slide_[term.node].dot(term.pull + term.stiffness * motion_[term.node]);
  }
  parts.bending = state.hand_force - (parts.friction + parts.inertia + parts.drag + parts.load);
  state.hand_parts = parts;
}

}  // namespace endovascular_sim::rod
