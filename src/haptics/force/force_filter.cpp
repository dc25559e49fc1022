#include "haptics/force/force_filter.h"

#include <algorithm>
#include <cmath>

#include "common/units.h"

namespace endovascular_sim::haptics
{
namespace
{

using units::kPi;

}  // namespace

double ForceFilter::State::next(double input, double omega, double dt)
{
  const double gain = omega * omega * dt;
  rate = (rate + gain * (input - value)) / (1.0 + std::sqrt(2.0) * omega * dt + gain * dt);
  value += dt * rate;
  return value;
}

HandForce ForceFilter::next(const HandForce& force, double now)
{
  if (cutoff_ <= 0.0 || !std::isfinite(force.force) || !std::isfinite(force.torque))
    return force;
  const double dt = std::max(0.0, now - time_);
  time_ = now;
  if (!started_)
  {
    force_ = {force.force, 0.0};
    torque_ = {force.torque, 0.0};
    started_ = true;
    return force;
  }
  const double omega = 2.0 * kPi * cutoff_;
  return {force_.next(force.force, omega, dt), torque_.next(force.torque, omega, dt)};
}

}  // namespace endovascular_sim::haptics
