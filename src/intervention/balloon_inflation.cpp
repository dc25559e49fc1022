#include "intervention/balloon_inflation.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::intervention
{
namespace
{

constexpr double kEmpty = 100.0;  // pressure below which a deflating balloon counts as empty [Pa]

}  // namespace

BalloonInflation::Event BalloonInflation::step(double dt, double commanded)
{
  const double target = burst_ ? std::min(commanded, 0.0) : commanded;
  const double time = target > pressure_ ? balloon_.inflation_time : balloon_.deflation_time;
  const double before = peak_pressure_;
  pressure_ = target + (pressure_ - target) * std::exp(-dt / time);
  if (target <= 0.0 && pressure_ < kEmpty)
    pressure_ = std::min(pressure_, 0.0);
  peak_pressure_ = std::max(peak_pressure_, pressure_);
  if (!burst_ && pressure_ > balloon_.burst_pressure)
  {
    burst_ = true;
    pressure_ = 0.0;
    return Event::kBurst;
  }
  const double rated = balloon_.rated_burst_pressure;
  return before <= rated && peak_pressure_ > rated ? Event::kAboveRated : Event::kNone;
}

double BalloonInflation::radiusOf(double diameter, double from_tip) const
{
  const double cylinder_end = balloon_.from_tip + balloon_.length;
  const double beyond = std::max(balloon_.from_tip - from_tip, from_tip - cylinder_end);
  return 0.5 * diameter * std::clamp(1.0 - beyond / coneLength(), 0.0, 1.0);
}

}  // namespace endovascular_sim::intervention
