#include "nodes/rod_dynamics/instruments/hand_force_renderer.h"

#include <algorithm>

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kLeastForcePeak = 5e-3;   ///< initial peak of the force limiters [N]
constexpr double kLeastTorquePeak = 5e-5;  ///< initial peak of the torque limiters [N·m]

}  // namespace

HandForceRenderer::HandForceRenderer(const std::vector<drive::HandCommand>& present)
  : hands_(present.size()),
    force_limiters_(present.size(), simulation::ForceFaultLimiter{kLeastForcePeak}),
    torque_limiters_(present.size(), simulation::ForceFaultLimiter{kLeastTorquePeak})
{
  for (std::size_t k = 0; k < present.size(); ++k)
    hands_[k].command = present[k];
}

const std::vector<RenderedHand>& HandForceRenderer::render(const simulation::Simulation& simulation,
                                                           const std::vector<drive::HandCommand>& used, double dt)
{
  const double fade = dt / kRampTime;
  // A rejected step gives no information about the force.
  share_ += simulation.report().solved ? fade : -fade;
  share_ = std::max(0.0, std::min(1.0, share_));
  const bool stale = simulation.report().first_stale_pass != contact::kNoStalePass;
  for (std::size_t k = 0; k < hands_.size(); ++k)
  {
    const simulation::HandState state = simulation.hand(static_cast<int>(k));
    hands_[k].command = used[k];
    hands_[k].force = share_ * force_limiters_[k].filter(state.force, stale, dt);
    hands_[k].torque = share_ * torque_limiters_[k].filter(state.torque, stale, dt);
  }
  return hands_;
}

void HandForceRenderer::reset()
{
  for (simulation::ForceFaultLimiter& limiter : force_limiters_)
    limiter.reset();
  for (simulation::ForceFaultLimiter& limiter : torque_limiters_)
    limiter.reset();
}

}  // namespace endovascular_sim::nodes
