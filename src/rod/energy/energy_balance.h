#pragma once

#include <array>

namespace endovascular_sim::rod
{

/** Energy balance of a wire over all steps so far [J]: work in = stored + dissipated + numerical + error.
 *
 *  Every term is computed from its own force and the motion of the nodes. None is the remainder of the others. */
struct EnergyBalance
{
  // Work on the wire.
  double push = 0.0;         ///< hands, along the wire
  double turn = 0.0;         ///< hands, about the wire
  double loads = 0.0;        ///< external forces and torques, motion of a held distal end and of rollers
  double pressure = 0.0;     ///< balloons that widen against the wall
  double stream = 0.0;       ///< drag of moving fluid (StepInput::drags); negative where the fluid brakes the wire
  double wall_motion = 0.0;  ///< moving wall (StepInput::wall): its forces, its friction, and the fluid that it carries

  // Stored since the start; a node that enters or leaves the simulated part does not count as a change.
  double kinetic = 0.0;
  double bending = 0.0;
  double twist = 0.0;
  double guide = 0.0;    ///< guide and sheath of the introducer
  double wall = 0.0;     ///< springs of contacts
  double gravity = 0.0;  ///< weight less buoyancy

  // Dissipated by the models.
  double wall_friction = 0.0;   ///< along the wire and across it
  double wall_rolling = 0.0;    ///< friction of the wall about the wire's axis
  double layer_friction = 0.0;  ///< between layers
  double valve = 0.0;           ///< valve of the introducer
  double damping = 0.0;         ///< mass-proportional
  double drag = 0.0;            ///< of the fluid at rest

  // Dissipated by the stages of the solver.
  double inertia = 0.0;     ///< backward Euler: ½ m |Δv|²
  double positions = 0.0;   ///< implicit positions: work of the final elastic force minus the change of energy
  double twisting = 0.0;    ///< relaxation of the twist, the same at fixed positions; snap-through
  double lengths = 0.0;     ///< inextensibility: work of the tensions on edges that turn
  double iteration = 0.0;   ///< minus the work of the residual that the last solve leaves at the free nodes
  double contact = 0.0;     ///< work of the wall's normal forces minus the change of its energy
  double insertion = 0.0;   ///< work of the hands' configurational forces minus the change of energy at fixed nodes
  double resampling = 0.0;  ///< change of nodes, its offsets that fade, and change of a stack's reference
  double rejected = 0.0;    ///< kinetic energy of rejected steps

  // No part of the sum.
  double configurational = 0.0;  ///< change of the potentials by the insertion at fixed nodes
  double turn_error = 0.0;       ///< part of error of the equations of the twist
  double turnover = 0.0;         ///< over all steps: magnitudes of the work, and of the change of stored energy

  double work() const { return push + turn + loads + pressure + stream + wall_motion; }
  double stored() const { return kinetic + bending + twist + guide + wall + gravity; }
  double dissipated() const { return wall_friction + wall_rolling + layer_friction + valve + damping + drag; }
  double numerical() const
  {
    return inertia + positions + twisting + lengths + iteration + contact + insertion + resampling + rejected;
  }
  /** Closing error: work that no term explains. */
  double error() const { return work() - stored() - dissipated() - numerical(); }

  EnergyBalance& operator+=(const EnergyBalance& other);
};

/** Term of a balance with its name in tables. */
struct BalanceTerm
{
  const char* name;
  double EnergyBalance::*value;
};

/** All terms in the order of the struct. */
constexpr std::array<BalanceTerm, 30> kBalanceTerms = {{
    {"push", &EnergyBalance::push},
    {"turn", &EnergyBalance::turn},
    {"loads", &EnergyBalance::loads},
    {"pressure", &EnergyBalance::pressure},
    {"stream", &EnergyBalance::stream},
    {"wall_motion", &EnergyBalance::wall_motion},
    {"kinetic", &EnergyBalance::kinetic},
    {"bending", &EnergyBalance::bending},
    {"twist", &EnergyBalance::twist},
    {"guide", &EnergyBalance::guide},
    {"wall", &EnergyBalance::wall},
    {"gravity", &EnergyBalance::gravity},
    {"wall_friction", &EnergyBalance::wall_friction},
    {"wall_rolling", &EnergyBalance::wall_rolling},
    {"layer_friction", &EnergyBalance::layer_friction},
    {"valve", &EnergyBalance::valve},
    {"damping", &EnergyBalance::damping},
    {"drag", &EnergyBalance::drag},
    {"inertia", &EnergyBalance::inertia},
    {"positions", &EnergyBalance::positions},
    {"twisting", &EnergyBalance::twisting},
    {"lengths", &EnergyBalance::lengths},
    {"iteration", &EnergyBalance::iteration},
    {"contact", &EnergyBalance::contact},
    {"insertion", &EnergyBalance::insertion},
    {"resampling", &EnergyBalance::resampling},
    {"rejected", &EnergyBalance::rejected},
    {"configurational", &EnergyBalance::configurational},
    {"turn_error", &EnergyBalance::turn_error},
    {"turnover", &EnergyBalance::turnover},
}};

inline EnergyBalance& EnergyBalance::operator+=(const EnergyBalance& other)
{
  for (const BalanceTerm& term : kBalanceTerms)
    this->*term.value += other.*term.value;
  return *this;
}

}  // namespace endovascular_sim::rod
