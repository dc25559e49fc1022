#include "flow/body/heart.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kShortestEjection = 0.12;  // [s]
constexpr double kLongestShare = 0.6;       // of a beat that the ejection takes
constexpr double kLoaded = 2.0 / 3.0;       // share of the largest pressure above which less is ejected

/** Smooth step from 0 at 0 to 1 at 1. */
double smooth(double x)
{
  const double limited = std::clamp(x, 0.0, 1.0);
  return limited * limited * (3.0 - 2.0 * limited);
}

}  // namespace

double Heart::ejectionTime(double rate)
{
  const double time = std::max(0.413 - 0.0017 * 60.0 * rate, kShortestEjection);
  return rate > 0.0 ? std::min(time, kLongestShare / rate) : time;
}

double Heart::strokeVolume() const
{
  const double rate = beat_rate_ > 0.0 ? beat_rate_ : settings_.rate;
  return std::min(settings_.output / rate, settings_.largest_stroke);
}

double Heart::period() const
{
  return 1.0 / (beat_rate_ > 0.0 ? beat_rate_ : settings_.rate);
}

double Heart::beatTime() const
{
  return phase_ * period();
}

void Heart::advance(double time_step)
{
  if (beat_rate_ <= 0.0 && rate_ > 0.0)
    beat_rate_ = rate_;  // the first beat, and the first one after an arrest
  if (beat_rate_ <= 0.0)
    return;
  phase_ += time_step * beat_rate_;
  if (phase_ < 1.0)
    return;
  ++beats_;
  // A rate counts from the next beat on: each beat has its volume.
  phase_ = rate_ > 0.0 ? (phase_ - 1.0) * rate_ / beat_rate_ : 0.0;
  beat_rate_ = rate_;
}

double Heart::inflow() const
{
  if (beat_rate_ <= 0.0)
    return 0.0;
  const double time = beatTime(), ejection = ejectionTime(beat_rate_), stroke = strokeVolume();
  const double back = settings_.backflow * stroke;
  if (time < ejection)
    return (stroke + back) * kPi / (2.0 * ejection) * std::sin(kPi * time / ejection);
  if (time < ejection + settings_.closure)
    return -back * kPi / (2.0 * settings_.closure) * std::sin(kPi * (time - ejection) / settings_.closure);
  return 0.0;
}

double Heart::inflow(double root) const
{
  const double flow = inflow();
  const double left = (1.0 - root / settings_.largest_pressure) / (1.0 - kLoaded);
  return flow > 0.0 ? flow * std::clamp(left, 0.0, 1.0) : flow;
}

double Heart::activation() const
{
  if (beat_rate_ <= 0.0)
    return 0.0;
  const double time = beatTime(), ejection = ejectionTime(beat_rate_);
  if (time <= ejection)
    return 1.0;
  const double relaxed = 1.0 - smooth((time - ejection) / settings_.relaxation);
  const double contracted = rate_ > 0.0 ? smooth(1.0 - (period() - time) / settings_.contraction) : 0.0;
  return std::max(relaxed, contracted);
}

void Heart::archive(Archive& archive)
{
  archive(rate_, beat_rate_, phase_, beats_);
}

}  // namespace endovascular_sim::flow
