#include "nodes/fluoroscopy/pulse_states.h"

#include <iterator>
#include <utility>

namespace endovascular_sim::nodes
{

PulseStates::Waiting& PulseStates::at(std::uint64_t steps)
{
  while (states_.size() >= kMost)
    states_.erase(states_.begin());
  return states_[steps];
}

void PulseStates::addInstruments(std::uint64_t steps, simulation::ImagedInstruments instruments, std::uint64_t stamp)
{
  if (steps < newest_)  // a new run, or a step back in a recording
  {
    states_.erase(states_.upper_bound(steps), states_.end());
    taken_.reset();
    at_pulses_ = false;
  }
  newest_ = steps;
  if (!recorded_ && pulses_.isPulse(steps))
    at_pulses_ = true;
  Waiting& state = at(steps);
  state.instruments = std::move(instruments);
  state.stamp = stamp;
}

void PulseStates::addTreatment(std::uint64_t steps, simulation::ImagedTreatment treatment)
{
  last_treatment_ = treatment;
  at(steps).treatment = std::move(treatment);
}

void PulseStates::addMotion(std::uint64_t steps, const fluoroscopy::BodyMotion& motion)
{
  last_motion_ = motion;
  at(steps).motion = motion;
}

void PulseStates::addContrast(std::uint64_t steps, simulation::ContrastMedium contrast)
{
  last_contrast_ = contrast;
  at(steps).contrast = std::move(contrast);
}

bool PulseStates::isReady(std::uint64_t steps, const Waiting& state) const
{
  if (!state.instruments || (taken_ && pulses_.newestAt(steps) <= *taken_))
    return false;
  if (!at_pulses_)
    return true;
  return pulses_.isPulse(steps) && (state.motion || !parts_.motion) && (state.treatment || !parts_.treatment) &&
         (state.contrast || !parts_.contrast);
}

std::optional<ImagedState> PulseStates::take(bool in_order)
{
  auto chosen = states_.end();
  for (auto state = states_.begin(); state != states_.end() && !(in_order && chosen != states_.end()); ++state)
    if (isReady(state->first, state->second))
      chosen = state;
  if (chosen == states_.end())
    return std::nullopt;
  ImagedState result;
  result.steps = chosen->first;
  result.pulse = pulses_.newestAt(chosen->first);
  result.stamp = chosen->second.stamp;
  result.instruments = std::move(*chosen->second.instruments);
  result.treatment = chosen->second.treatment ? std::move(chosen->second.treatment) : last_treatment_;
  result.contrast = chosen->second.contrast ? std::move(chosen->second.contrast) : last_contrast_;
  result.motion = chosen->second.motion ? std::move(chosen->second.motion) : last_motion_;
  states_.erase(states_.begin(), std::next(chosen));
  taken_ = result.pulse;
  return result;
}

}  // namespace endovascular_sim::nodes
