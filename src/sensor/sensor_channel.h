#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "sensor/sensor_settings.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::sensor
{

/** Sample of a sensor. */
struct Reading
{
  std::uint64_t sequence = 0;  ///< number of the sample, from 1; 0 before the first delivery
  std::uint64_t step = 0;      ///< step after which it was measured
  bool valid = false;          ///< false: lost, or there was nothing to measure
  std::vector<double> values;  ///< of the newest valid sample; zeros before the first one

  void archive(Archive& archive);
};

/** Errors of one sample, as many as errorsOf(); the rest is zero. */
using Errors = std::array<double, kMostErrors>;

/** Samples of one sensor in time: rate, errors, drop-outs, delay.
 *
 *  Sample n is measured in the first step that ends at n/rate or later, and delivered after the delay, rounded to
 *  whole steps. Its errors and its loss are functions of the seed and n only. */
class SensorChannel
{
public:
  /** @param time_step of the simulation [s]
   *  @param seed of the run; varies the random numbers of all sensors */
  SensorChannel(const SensorSettings& settings, double time_step, std::uint64_t seed);

  const SensorSettings& settings() const { return settings_; }

  /** Draws the random numbers of later samples with another seed of the run. */
  void setSeed(std::uint64_t seed);

  /** Measures with errors. @return false if there is nothing to measure */
  using Measure = std::function<bool(const Errors& errors, std::vector<double>& values)>;

  /** Takes and delivers the samples of a step.
   *  @param step number of steps so far, increasing from call to call
   *  @return true if a sample was delivered */
  bool update(std::uint64_t step, const Measure& measure);

  /** Newest delivered sample. */
  const Reading& reading() const { return reading_; }

  /** Saves or loads the samples. @throws ArchiveError for invalid data */
  void archive(Archive& archive);

private:
  std::uint64_t samplesUntil(std::uint64_t step) const;
  Errors errors(std::uint64_t sample) const;
  void take(std::uint64_t step, std::uint64_t sample, const Measure& measure);
  void deliver(const Reading& sample);

  SensorSettings settings_;
  double samples_per_step_;    ///< at most 1
  std::uint64_t delay_;        ///< [steps]
  std::uint64_t stream_;       ///< of the random numbers, from the name
  std::uint64_t seed_ = 0;     ///< of the random numbers
  std::deque<Reading> taken_;  ///< samples that wait for their delivery
  Reading reading_;
};

}  // namespace endovascular_sim::sensor
