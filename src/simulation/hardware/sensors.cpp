#include "simulation/hardware/sensors.h"

#include <algorithm>

#include "common/archive.h"
#include "common/numerics/counter_hash.h"
#include "simulation/instrument_tip.h"
#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{
namespace
{

/** Pose of a tip with errors.
 *  @return false where the tip is outside of the introducer */
bool measurePose(const Simulation& simulation, int instrument, const sensor::Errors& errors,
                 std::vector<double>& values)
{
  const double insertion = simulation.hand(instrument).insertion;
  if (insertion < 0.0)
    return false;
  const Eigen::Vector3d position = pointAt(simulation, insertion) + Eigen::Vector3d(errors[0], errors[1], errors[2]);
  Eigen::Quaterniond rotation(tipFrame(simulation, instrument));
  const Eigen::Vector3d turn(errors[3], errors[4], errors[5]);
  if (!turn.isZero(0.0))
    rotation = rotation * Eigen::AngleAxisd(turn.norm(), turn.normalized());
  rotation.normalize();
  if (rotation.w() < 0.0)
    rotation.coeffs() = -rotation.coeffs();
  values = {position.x(), position.y(), position.z(), rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  return true;
}

}  // namespace

Sensors::Sensors(const scene::Scene& scene, std::uint64_t seed)
  : scene_seed_(scene.seed), is_new_(scene.sensors.size(), 0)
{
  for (const sensor::SensorSettings& settings : scene.sensors)
  {
    channels_.emplace_back(settings, scene.solver.time_step, 0);
    if (settings.kind == sensor::SensorKind::kDetector && !x_ray_)
      x_ray_.emplace(scene.fluoroscopy->pose());
  }
  setSeed(seed);
}

void Sensors::setSeed(std::uint64_t seed)
{
  for (sensor::SensorChannel& channel : channels_)
    channel.setSeed(mixedBits(scene_seed_) ^ seed);
}

/** Pixel of a tip with errors.
 *  @return false where the tip is outside of the introducer, or of the image */
bool Sensors::measurePixel(const Simulation& simulation, const sensor::SensorSettings& settings,
                           const sensor::Errors& errors, std::vector<double>& values) const
{
  const double insertion = simulation.hand(static_cast<int>(settings.instrument)).insertion;
  const Eigen::Vector3d tip = pointAt(simulation, std::max(0.0, insertion));
  if (insertion < 0.0 || x_ray_->toOptical(tip).z() <= 0.0)
    return false;
  const Eigen::Vector2d pixel = x_ray_->project(tip);
  if (pixel.minCoeff() < -0.5 || pixel.maxCoeff() > x_ray_->pixels() - 0.5)
    return false;
  values = {pixel.x() + errors[0], pixel.y() + errors[1]};
  return true;
}

bool Sensors::measure(const Simulation& simulation, const sensor::SensorSettings& settings,
                      const sensor::Errors& errors, std::vector<double>& values) const
{
  const auto instrument = static_cast<int>(settings.instrument);
  const HandState hand = simulation.hand(instrument);
  switch (settings.kind)
  {
    case sensor::SensorKind::kEmTracker:
      return measurePose(simulation, instrument, errors, values);
    case sensor::SensorKind::kEncoder:
      values = {hand.insertion + errors[0], hand.rotation + errors[1]};
      return true;
    case sensor::SensorKind::kForceSensor:
      values = {hand.force + errors[0], hand.torque + errors[1]};
      return true;
    case sensor::SensorKind::kDetector:
      return measurePixel(simulation, settings, errors, values);
  }
  return false;
}

void Sensors::update(const Simulation& simulation)
{
  for (std::size_t k = 0; k < channels_.size(); ++k)
  {
    const auto measure = [&](const sensor::Errors& errors, std::vector<double>& values)
    { return this->measure(simulation, channels_[k].settings(), errors, values); };
    is_new_[k] = channels_[k].update(simulation.steps(), measure) ? 1 : 0;
  }
}

void Sensors::archive(Archive& archive)
{
  for (sensor::SensorChannel& channel : channels_)
    archive(channel);
}

}  // namespace endovascular_sim::simulation
