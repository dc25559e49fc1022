#include "sensor/sensor_channel.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/hash.h"
#include "common/numerics/counter_hash.h"
#include "common/numerics/counter_noise.h"

namespace endovascular_sim::sensor
{
namespace
{

constexpr double kSameSample = 1e-6;    ///< tolerance of the time of a sample, relative to their distance
constexpr std::uint64_t kStreams = 8;   ///< streams of random numbers per sensor: pairs of errors, losses
constexpr std::uint64_t kOfLosses = 7;  ///< number of the stream of losses

std::uint64_t streamOf(const std::string& name)
{
  Hash64 hash;
  hash.add(name);
  return hash.value() * kStreams;
}

}  // namespace

void Reading::archive(Archive& archive)
{
  archive(sequence, step, valid, values);
  if (archive.reading())
    requireFinite(values);
}

SensorChannel::SensorChannel(const SensorSettings& settings, double time_step, std::uint64_t seed)
  : settings_(settings),
    samples_per_step_(settings.rate > 0.0 ? std::min(1.0, settings.rate * time_step) : 1.0),
    delay_(static_cast<std::uint64_t>(std::llround(settings.delay / time_step))),
    stream_(streamOf(settings.name))
{
  reading_.values.assign(valuesOf(settings.kind), 0.0);
  setSeed(seed);
}

void SensorChannel::setSeed(std::uint64_t seed)
{
  seed_ = mixedBits(settings_.seed ^ mixedBits(seed));
}

/** Number of samples that are due until a step. */
std::uint64_t SensorChannel::samplesUntil(std::uint64_t step) const
{
  return static_cast<std::uint64_t>(std::floor(static_cast<double>(step) * samples_per_step_ + kSameSample));
}

Errors SensorChannel::errors(std::uint64_t sample) const
{
  Errors errors{};
  for (std::size_t k = 0; k < errorsOf(settings_.kind); k += 2)
  {
    float a = 0.0F;
    float b = 0.0F;
    CounterNoise(seed_, stream_ + k / 2).fill(static_cast<std::uint32_t>(sample), 1, &a, &b);
    errors[k] = settings_.bias[k] + settings_.noise[k] * static_cast<double>(a);
    errors[k + 1] = settings_.bias[k + 1] + settings_.noise[k + 1] * static_cast<double>(b);
  }
  return errors;
}

void SensorChannel::take(std::uint64_t step, std::uint64_t sample, const Measure& measure)
{
  Reading taken;
  taken.sequence = sample;
  taken.step = step;
  taken.values.assign(reading_.values.size(), 0.0);
  const bool is_lost =
      settings_.drop_out > 0.0 && uniformNumber(seed_, stream_ + kOfLosses, sample) < settings_.drop_out;
  taken.valid = !is_lost && measure(errors(sample), taken.values);
  taken_.push_back(std::move(taken));
}

/** A sample without a measurement leaves the values of the one before. */
void SensorChannel::deliver(const Reading& sample)
{
  reading_.sequence = sample.sequence;
  reading_.step = sample.step;
  reading_.valid = sample.valid;
  if (sample.valid)
    reading_.values = sample.values;
}

bool SensorChannel::update(std::uint64_t step, const Measure& measure)
{
  const std::uint64_t due = samplesUntil(step);
  if (step > 0 && due > samplesUntil(step - 1))
    take(step, due, measure);
  bool is_delivered = false;
  for (; !taken_.empty() && taken_.front().step + delay_ <= step; taken_.pop_front())
  {
    deliver(taken_.front());
    is_delivered = true;
  }
  return is_delivered;
}

void SensorChannel::archive(Archive& archive)
{
  archive(taken_, reading_);
  if (!archive.reading())
    return;
  requireLength(valuesOf(settings_.kind), reading_.values);
  for (const Reading& sample : taken_)
    requireLength(valuesOf(settings_.kind), sample.values);
}

}  // namespace endovascular_sim::sensor
