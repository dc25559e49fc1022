#include "nodes/haptic_device/haptic_parameters.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "nodes/haptic_device/haptic_topics.h"
#include "nodes/runtime/parameters.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kFrameBits = 210.0;   ///< length of a sample or a force on the line [bit]
constexpr double kDeviceDelay = 2e-3;  ///< upper estimate of the delay in the device and this computer [s]
}  // namespace

const scene::DrivenInstrument& deviceInstrument(const scene::Scene& scene)
{
  const auto device = std::find_if(scene.instruments.begin(), scene.instruments.end(),
                                   [](const scene::DrivenInstrument& candidate)
                                   { return candidate.drive.source == scene::DriveSource::kDevice; });
  return device != scene.instruments.end() ? *device : scene.instruments.front();
}

haptics::LinkOptions linkOptions(const ros::NodeHandle& parameters, const scene::Scene& scene)
{
  haptics::LinkOptions options;
  options.port = parameters.param<std::string>("port", "/dev/ttyACM0");
  options.baud = parameters.param("baud", options.baud);
  haptics::SerialPort::checkBaud(options.baud, parameters.resolveName("baud"));
  options.host.types = hapticTopicTypes();
  options.host.start = std::nullopt;  // the position of the instrument, which comes with its force
  haptics::ForceLimits& limits = options.host.limits;
  const auto positive = [&parameters](const char* name, double fallback, const Quantity& quantity)
  {
    const double value = numericParameter(parameters, name, fallback, quantity);
    if (value <= 0.0)
      throw InputError("parameter server", parameters.resolveName(name), "must be a positive number");
    return value;
  };
  limits.force = positive("force_limit", std::min(limits.force, deviceInstrument(scene).drive.force_limit),
                          quantities::kForceLimit);
  limits.torque = positive("torque_limit", std::min(limits.torque, deviceInstrument(scene).drive.torque_limit),
                           quantities::kTorqueLimit);
  limits.force_rate = positive("force_rate", limits.force_rate, quantities::kForceRate);
  limits.torque_rate = positive("torque_rate", limits.torque_rate, quantities::kTorqueRate);
  haptics::ShaperSettings& shaping = options.host.shaping;
  shaping.passivity = parameters.param("passivity", shaping.passivity);
  shaping.cutoff = numericParameter(parameters, "force_cutoff", shaping.cutoff, quantities::kCutoff);
  if (shaping.cutoff < 0.0)
    throw InputError("parameter server", parameters.resolveName("force_cutoff"), "must not be negative");
  const double line_delay = 2.0 * kFrameBits / static_cast<double>(options.baud);
  shaping.insertion.delay = shaping.rotation.delay =
      positive("loop_delay", line_delay + kDeviceDelay, quantities::kDelay);
  shaping.insertion.resolution =
      positive("insertion_resolution", shaping.insertion.resolution, quantities::kResolution);
  shaping.rotation.resolution =
      positive("rotation_resolution", shaping.rotation.resolution, quantities::kAngularResolution);
  shaping.insertion.damping_limit =
      positive("damping_limit", shaping.insertion.damping_limit, quantities::kDamperInsertion);
  shaping.rotation.damping_limit =
      positive("turning_damping_limit", shaping.rotation.damping_limit, quantities::kDamperRotation);
  shaping.insertion.force_limit = std::min(shaping.insertion.force_limit, limits.force);
  shaping.rotation.force_limit = std::min(shaping.rotation.force_limit, limits.torque);
  return options;
}

}  // namespace endovascular_sim::nodes
