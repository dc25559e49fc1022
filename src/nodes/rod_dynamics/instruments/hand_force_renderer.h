#pragma once

#include <vector>

#include "simulation/degraded/force_fault_limiter.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Command that the last step used for one instrument, and the force and torque rendered to the hand. */
struct RenderedHand
{
  drive::HandCommand command;
  double force = 0.0;   ///< positive against insertion [N]
  double torque = 0.0;  ///< positive against rotation [N·m]
};

/** Rendered forces of all instruments: the reaction forces of the simulation, limited in slew rate after missing
 * contact sets, and faded out while steps are rejected. */
class HandForceRenderer
{
public:
  /** @param present commands before the first step, one per instrument */
  explicit HandForceRenderer(const std::vector<drive::HandCommand>& present);

  /** Renders the forces after a step.
   *  @param used commands of the step, one per instrument
   *  @param dt duration of the step [s] */
  const std::vector<RenderedHand>& render(const simulation::Simulation& simulation,
                                          const std::vector<drive::HandCommand>& used, double dt);

  /** Resets the forces to zero; the next steps approach the simulation's forces from there. */
  void reset();

  const std::vector<RenderedHand>& hands() const { return hands_; }
  bool isFaded() const { return share_ < 1.0; }  ///< true after rejected steps, until the forces are complete again

  static constexpr double kRampTime = 30e-3;  ///< duration in which a force fades to zero, or in again [s]

private:
  std::vector<RenderedHand> hands_;
  std::vector<simulation::ForceFaultLimiter> force_limiters_, torque_limiters_;  ///< one per instrument
  double share_ = 1.0;  ///< rendered share of the forces; fades while steps are rejected [1]
};

}  // namespace endovascular_sim::nodes
