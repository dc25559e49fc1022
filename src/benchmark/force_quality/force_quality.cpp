#include "benchmark/force_quality/force_quality.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kWindow = 0.25;        // s
constexpr double kPart = 10e-3;         // s: parts of a window, each of which must move
constexpr double kLeastSpeed = 1e-3;    // m/s
constexpr double kLeastTurning = 0.05;  // rad/s
constexpr double kMillisecond = 1e-3;   // s

std::size_t stepsIn(double seconds, double time_step)
{
  return static_cast<std::size_t>(std::max(1.0, std::round(seconds / time_step)));
}

/** True if a motion keeps its direction and its least speed between two steps, and for a part before and after them. */
bool isSteady(const std::vector<HandReaction>& reactions, double HandReaction::*motion, std::size_t begin,
              std::size_t end, double least, double time_step)
{
  const std::size_t part = stepsIn(kPart, time_step);
  if (begin < part || end + part >= reactions.size())
    return false;
  begin -= part;
  end += part;
  const double direction = reactions[end].*motion - reactions[begin].*motion;
  for (std::size_t k = begin; k + part <= end; k += part)
    if ((reactions[k + part].*motion - reactions[k].*motion) * std::copysign(1.0, direction) <
        least * time_step * static_cast<double>(part))
      return false;
  return true;
}

/** Standard deviation of values at equal distances about their linear regression. */
double deviationAboutTrend(const std::vector<double>& values)
{
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  double moment = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k)
  {
    const double at = static_cast<double>(k) - 0.5 * (n - 1.0);
    mean += values[k] / n;
    moment += at * values[k];
    squares += at * at;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k)
  {
    const double at = static_cast<double>(k) - 0.5 * (n - 1.0);
    const double rest = values[k] - mean - moment / squares * at;
    sum += rest * rest / n;
  }
  return std::sqrt(sum);
}

ReactionQuality qualityOf(const std::vector<HandReaction>& reactions, double time_step, double HandReaction::*reaction,
                          double HandReaction::*motion, double least, const ForceReference& reference)
{
  ReactionQuality quality;
  const std::size_t window = stepsIn(kWindow, time_step);
  const std::size_t millisecond = stepsIn(kMillisecond, time_step);
  std::vector<double> values(window + 1);
  for (std::size_t begin = 0; begin + window < reactions.size(); begin += window)
  {
    if (!isSteady(reactions, motion, begin, begin + window, least, time_step))
      continue;
    double magnitude = 0.0;
    for (std::size_t k = begin; k <= begin + window; ++k)
    {
      values[k - begin] = reactions[k].*reaction;
      magnitude += std::abs(reactions[k].*reaction) / static_cast<double>(window + 1);
      if (k < begin + millisecond)
        continue;
      const HandReaction& before = reactions[k - millisecond];
      double change = std::abs(reactions[k].*reaction - before.*reaction);
      if (reference)
        change -= std::abs(reference(reactions[k].insertion) - reference(before.insertion));
      if (change > quality.largest_change)
      {
        quality.largest_change = change;
        quality.change_time = static_cast<double>(k + 1) * time_step;
      }
    }
    ++quality.windows;
    quality.deviation += (deviationAboutTrend(values) - quality.deviation) / quality.windows;
    quality.mean += (magnitude - quality.mean) / quality.windows;
  }
  return quality;
}

}  // namespace

double ReactionQuality::noise() const
{
  return windows > 0 && mean > 0.0 ? deviation / mean : std::numeric_limits<double>::quiet_NaN();
}

HandQuality handQuality(const std::vector<HandReaction>& reactions, double time_step, const ForceReference& reference)
{
  return {qualityOf(reactions, time_step, &HandReaction::force, &HandReaction::insertion, kLeastSpeed, reference),
          qualityOf(reactions, time_step, &HandReaction::torque, &HandReaction::rotation, kLeastTurning, {})};
}

}  // namespace endovascular_sim::benchmark
