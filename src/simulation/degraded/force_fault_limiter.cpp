#include "simulation/degraded/force_fault_limiter.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kPeakGrowth = 1.02;  ///< largest growth of the peak per limited step [1]

}  // namespace

double ForceFaultLimiter::filter(double force, bool stale, double dt)
{
  const double most = dt * kRate * peak_;
  if (stale)
  {
    remaining_ = kSettlingTime;
    return output_;
  }
  if (remaining_ > 0.0)
  {
    const double difference = force - output_;
    output_ += std::clamp(difference, -most, most);
    // Bounded growth: the peak follows lasting changes of the force, but not a single spike after a stale set.
    peak_ = std::max(peak_, std::min(std::abs(force), kPeakGrowth * peak_));
    // The limit ends only after the output has met the force, so its end causes no jump.
    remaining_ = remaining_ > dt || std::abs(difference) <= most ? remaining_ - dt : remaining_;
    return output_;
  }
  peak_ = std::max(peak_, std::abs(force));
  output_ = force;
  return output_;
}

void ForceFaultLimiter::reset()
{
  output_ = 0.0;
  remaining_ = kSettlingTime;
}

}  // namespace endovascular_sim::simulation
