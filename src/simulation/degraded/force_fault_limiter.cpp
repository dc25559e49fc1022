#include "simulation/degraded/force_fault_limiter.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kPeakGrowth = 1.02;  // per step

}  // namespace

double ForceFaultLimiter::told(double force, bool blind, double dt)
{
  const double most = dt * kRate * peak_;
  if (blind)
  {
    left_ = kSettlingTime;
    return told_;
  }
  if (left_ > 0.0)
  {
    const double missing = force - told_;
    told_ += std::clamp(missing, -most, most);
    // Not sooner than the force has been met: what is left to go then is no jump.
    // It may grow under lasting faults, but hardly by a blow.
    peak_ = std::max(peak_, std::min(std::abs(force), kPeakGrowth * peak_));
    left_ = left_ > dt || std::abs(missing) <= most ? left_ - dt : left_;
    return told_;
  }
  peak_ = std::max(peak_, std::abs(force));
  told_ = force;
  return told_;
}

void ForceFaultLimiter::drop()
{
  told_ = 0.0;
  left_ = kSettlingTime;
}

}  // namespace endovascular_sim::simulation
