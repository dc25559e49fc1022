#include "rod/boundary/hand_force_parts.h"
#include "rod/boundary/reaction_forces.h"
#include "rod/kkt/kkt_stepper.h"

// Reaction forces at the held ends, and the parts of the handle force.

namespace endovascular_sim::rod
{

/** Force of the wire on what holds a node: what is left of the node's own equation at the solution [N]. */
Eigen::Vector3d KktStepper::forceOnHold(int node, double dt) const
{
  return remainder(base_, Eigen::Vector3d(base_rhs_.data() + row(node)), rhs_, row(node)) / (dt * dt);
}

void KktStepper::updateEndForces(State& state, double dt) const
{
  const int free = conditions_.firstFreeNode(state);
  rod::updateEndForces(
      state, boundary_, [this, free](int node) { return node < free || conditions_.isDistalHeld(node); },
      [this, dt](int node) { return forceOnHold(node, dt); });
}

/** Bending takes what the others leave: elastic forces, the wall's normal ones and the guide's. */
void KktStepper::updateHandParts(State& state, double dt)
{
  const int n = rod_.nodes();
  slideAlongItself(state.position, motion_, first_, conditions_.firstFreeNode(state) - 1, boundary_.direction, slide_);
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
