#include "rod/kkt/kkt_reactions.h"

#include "rod/boundary/hand_force_parts.h"
#include "rod/boundary/reaction_forces.h"

namespace endovascular_sim::rod
{
namespace
{

void updateTensions(const KktSolution& solution, State& state)
{
  const double to_force = solution.system.scale / (solution.dt * solution.dt);
  for (int j = state.first_node; j + 1 < solution.model.rod.nodes(); ++j)
    state.tension[j] = to_force * solution.unknowns[solution.system.multiplierRow(j)];
}

/** Force of the wire on the hold of a node: the remainder of the node's own equation [N]. */
Eigen::Vector3d forceOnHold(const KktSolution& solution, int node)
{
  const KktSystem& system = solution.system;
  const int row = system.row(node);
  return remainder(system.matrix, Eigen::Vector3d(system.rhs.data() + row), solution.unknowns, row) /
         (solution.dt * solution.dt);
}

}  // namespace

void KktReactions::update(const KktSolution& solution, State& state)
{
  updateTensions(solution, state);
  const BoundaryConditions& conditions = solution.model.conditions;
  const int free = conditions.firstFreeNode(state);
  updateEndForces(
      state, solution.model.boundary,
      [&conditions, free](int node) { return node < free || conditions.isDistalHeld(node); },
      [&solution](int node) { return forceOnHold(solution, node); });
  state.hand_force += solution.rest_force;
  updateHandParts(solution, state);
}

/** Bending is the remainder of the force: elastic forces, the normal forces of the wall and those of the guide. */
void KktReactions::updateHandParts(const KktSolution& solution, State& state)
{
  const KktModel& model = solution.model;
  const int n = model.rod.nodes();
  const int first = state.first_node;
  slideAlongItself(state.position, solution.motion, first, model.conditions.firstFreeNode(state) - 1,
                   model.boundary.direction, slide_);
  const double inverse = 1.0 / solution.dt;
  const bool heavy = !model.environment.gravity.isZero(0.0);
  HandForceParts parts;
  parts.friction = parts.inertia = parts.drag = parts.load = 0.0;
  for (int i = first; i < n; ++i)
  {
    const double travel = slide_[i].dot(state.position[i] - solution.begin[i]);
    parts.inertia += model.rod.mass[i] * inverse * (inverse * travel - slide_[i].dot(state.velocity[i]));
    parts.drag += solution.resistance.coefficient[i] * inverse * inverse * travel;
    if (solution.slides != nullptr)
      parts.inertia += model.rod.mass[i] * inverse * inverse * slide_[i].dot(solution.slides->mass[i].gained);
    if (solution.slides != nullptr || solution.wall != nullptr)
      parts.drag += inverse * inverse * slide_[i].dot(solution.resistance.slide[i]);
    if (heavy)
      parts.load -= model.immersedMass(i) * slide_[i].dot(model.environment.gravity);
  }
  for (const NodalForce& force : solution.forces)
    if (force.node >= first)
      parts.load -= slide_[force.node].dot(force.force);
  for (const NodalDrag& drag : solution.drags)
    if (const int i = drag.node; i >= first)
      parts.drag -= slide_[i].dot(
          drag.force(state.position[i] - solution.begin[i] + surfaceSlide(solution.slides, i), solution.dt));
  parts.load += slide_.back().dot(state.distal_force);
  for (std::size_t k = 0; k < solution.friction.count(); ++k)
  {
    const WallFriction::Term& term = solution.friction.term(k);
    parts.friction += slide_[term.node].dot(term.pullAfter(solution.motion[term.node]));
  }
  parts.bending = state.hand_force - (parts.friction + parts.inertia + parts.drag + parts.load);
  parts.configurational = solution.introducer_force + solution.rest_force;
  state.hand_parts = parts;
}

}  // namespace endovascular_sim::rod
