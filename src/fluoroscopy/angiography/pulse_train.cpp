#include "fluoroscopy/angiography/pulse_train.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kRounding = 1e-6;  // of a time that is a multiple of the step, e.g. 3/(15 Hz · 1 ms) [step]

constexpr std::uint64_t kExact = std::uint64_t{1} << 50;  // largest number of steps that is computed to one step

}  // namespace

std::uint64_t PulseTrain::stepOf(std::uint64_t pulse) const
{
  return static_cast<std::uint64_t>(
      std::max(0.0, std::ceil(static_cast<double>(pulse) * steps_per_pulse_ - kRounding)));
}

std::uint64_t PulseTrain::newestAt(std::uint64_t steps) const
{
  auto pulse = static_cast<std::uint64_t>((static_cast<double>(steps) + kRounding) / steps_per_pulse_);
  if (steps > kExact)  // no simulation, but a message may claim it
    return pulse;
  if (stepOf(pulse + 1) <= steps)
    ++pulse;
  if (pulse > 0 && stepOf(pulse) > steps)
    --pulse;
  return pulse;
}

}  // namespace endovascular_sim::fluoroscopy
