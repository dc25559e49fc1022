#include "haptics/force/passivity_channel.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::haptics
{
namespace
{

constexpr double kHighPassTime = 0.15;     // time constant of the high-pass filter [s]
constexpr double kCreditTime = 1.0;        // time constant of the decay of the energy bound [s]
constexpr double kSpeedTime = 2e-3;        // time constant of the velocity filter [s]
constexpr double kFadeTime = 50e-3;        // time constant of the decay of the injected damping [s]
constexpr double kNegligibleShare = 1e-3;  // share of the damping limit below which the injection ends
constexpr double kLongestStep = 20e-3;     // interval without a sample after which the observer restarts [s]

}  // namespace

double PassivityChannel::HighPass::next(double value, double dt)
{
  if (!started)
    low = value;
  started = true;
  low += dt / (kHighPassTime + dt) * (value - low);
  return value - low;
}

void PassivityChannel::reset()
{
  const std::uint64_t activations = report_.activations;
  const double dissipated = report_.dissipated;
  *this = PassivityChannel(settings_);
  report_.activations = activations;
  report_.dissipated = dissipated;
}

void PassivityChannel::rendered(double force, double now)
{
  sent_[sent_count_++ % sent_.size()] = {force, now};
}

double PassivityChannel::forceAt(double time) const
{
  const std::size_t known = std::min(sent_count_, sent_.size());
  for (std::size_t back = 1; back <= known; ++back)
  {
    const Sent& sent = sent_[(sent_count_ - back) % sent_.size()];
    if (sent.time <= time)
      return sent.force;
  }
  return 0.0;
}

void PassivityChannel::observe(double position, double dt, double now)
{
  if (!started_ || !(dt > 0.0) || dt > kLongestStep)
  {
    reset();
    last_ = position;
    started_ = true;
    position_ = position_high_.next(position, 0.0);
    return;
  }
  const double travel = position - last_;
  last_ = position;
  speed_ += dt / (kSpeedTime + dt) * (travel / dt - speed_);
  const double delayed = forceAt(now - dt - settings_.delay);
  const double force = force_high_.next(delayed, dt);
  const double previous = position_;
  position_ = position_high_.next(position, dt);
  report_.energy += force * (position_ - previous) + settings_.damping * speed_ * speed_ * dt;
  credit_ = std::max(std::abs(force * position_), credit_ * (1.0 - dt / kCreditTime));
  report_.energy = std::clamp(report_.energy, -credit_, credit_);
  if (report_.injected_damping > 0.0)
    report_.dissipated +=
        std::min(report_.injected_damping * std::abs(speed_), settings_.force_limit) * std::abs(speed_) * dt;
  force_ = force;
  inject(dt);
}

void PassivityChannel::inject(double dt)
{
  const double deficit = -report_.energy - settings_.resolution * std::abs(force_);
  double damping = report_.injected_damping * (1.0 - std::min(1.0, dt / kFadeTime));
  if (damping < kNegligibleShare * settings_.damping_limit)
    damping = 0.0;
  if (deficit > 0.0 && speed_ != 0.0)
  {
    report_.activations += damping == 0.0;
    damping = std::max(damping, std::min(settings_.damping_limit, deficit / (speed_ * speed_ * dt)));
  }
  report_.injected_damping = damping;
}

double PassivityChannel::control(double force) const
{
  if (report_.injected_damping == 0.0)
    return force;
  return force + std::clamp(report_.injected_damping * speed_, -settings_.force_limit, settings_.force_limit);
}

}  // namespace endovascular_sim::haptics
