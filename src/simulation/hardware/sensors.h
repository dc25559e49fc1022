#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fluoroscopy/projection/x_ray_geometry.h"
#include "scene/model/scene.h"
#include "sensor/sensor_channel.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

class Simulation;

/** Sensors of a scene, on the instruments of a simulation. Readings are functions of the trajectory, the number of
 * steps and the seeds only. */
class Sensors
{
public:
  /** @param seed of the run; varies all random numbers */
  Sensors(const scene::Scene& scene, std::uint64_t seed);

  /** Measures after a step; to be called after each one. */
  void update(const Simulation& simulation);

  /** Sensors in the order of the scene. */
  std::size_t size() const { return channels_.size(); }
  const sensor::SensorSettings& settings(std::size_t sensor) const { return channels_[sensor].settings(); }

  /** Newest delivered sample of a sensor. */
  const sensor::Reading& reading(std::size_t sensor) const { return channels_[sensor].reading(); }

  /** True if the last step delivered a sample. */
  bool isNew(std::size_t sensor) const { return is_new_[sensor] != 0; }

  /** Draws the errors and losses of later samples with another seed of the run. */
  void setSeed(std::uint64_t seed);

  /** Saves or loads all samples. @throws ArchiveError for invalid data */
  void archive(Archive& archive);

private:
  bool measure(const Simulation& simulation, const sensor::SensorSettings& settings, const sensor::Errors& errors,
               std::vector<double>& values) const;
  bool measurePixel(const Simulation& simulation, const sensor::SensorSettings& settings, const sensor::Errors& errors,
                    std::vector<double>& values) const;

  std::uint64_t scene_seed_;
  std::vector<sensor::SensorChannel> channels_;
  std::vector<char> is_new_;                        ///< 1: the last step delivered a sample
  std::optional<fluoroscopy::XRayGeometry> x_ray_;  ///< empty without a detector
};

}  // namespace endovascular_sim::simulation
