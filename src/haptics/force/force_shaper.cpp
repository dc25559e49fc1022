#include "haptics/force/force_shaper.h"

namespace endovascular_sim::haptics
{

ForceShaper::ForceShaper(const ShaperSettings& settings)
  : settings_(settings), filter_(settings.cutoff), insertion_(settings.insertion), rotation_(settings.rotation)
{
}

void ForceShaper::sample(const HandMotion& motion, std::uint32_t device_time, double now)
{
  if (!settings_.passivity)
    return;
  // The device's clock is free of the jitter of the serial line. Without a device clock, arrival times are used.
  const std::uint32_t elapsed = device_time - device_time_;
  const double dt = elapsed > 0 ? 1e-6 * static_cast<double>(elapsed) : now - arrival_;
  device_time_ = device_time;
  arrival_ = now;
  insertion_.observe(motion.insertion, dt, now);
  rotation_.observe(motion.rotation, dt, now);
}

HandForce ForceShaper::shape(const HandForce& wanted, double now)
{
  const HandForce force = filter_.next(wanted, now);
  if (!settings_.passivity)
    return force;
  return {insertion_.control(force.force), rotation_.control(force.torque)};
}

void ForceShaper::rendered(const HandForce& force, double now)
{
  insertion_.rendered(force.force, now);
  rotation_.rendered(force.torque, now);
}

void ForceShaper::reset()
{
  filter_.reset();
  insertion_.reset();
  rotation_.reset();
}

}  // namespace endovascular_sim::haptics
