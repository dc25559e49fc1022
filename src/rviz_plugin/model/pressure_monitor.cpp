#include "rviz_plugin/model/pressure_monitor.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kFall = 0.05;          // of the time that begins another run [s]
constexpr double kLeastPressure = 1.0;  // mean pressure of a line that is in the vessel [Pa]
constexpr double kSpan = 1.2;           // during which the highest and the lowest reading are sought, in beats

/** Wave of an electrocardiogram. */
struct Wave
{
  double phase, width, height;
};

// Phases relative to the opening of the aortic valve; the R wave precedes it by some 50 ms of 860 ms.
constexpr Wave kWaves[] = {
    {0.76, 0.025, 0.15}, {0.915, 0.008, -0.12}, {0.935, 0.009, 1.0}, {0.955, 0.009, -0.22}, {0.24, 0.045, 0.28}};

}  // namespace

double electrocardiogram(double phase)
{
  double voltage = 0.0;
  for (const Wave& wave : kWaves)
  {
    double distance = phase - wave.phase;
    distance -= std::round(distance);
    voltage += wave.height * std::exp(-0.5 * distance * distance / (wave.width * wave.width));
  }
  return voltage;
}

void PressureMonitor::setLines(const std::vector<std::string>& names, std::vector<std::string> frames)
{
  if (frames == frames_)
    return;
  frames_ = std::move(frames);
  names_ = names;
  readings_.assign(frames_.size(), {});
}

void PressureMonitor::restartAfterFall(double time)
{
  const double newest = phases_.empty() ? time : phases_.back().first;
  if (time >= newest - kFall)
    return;
  phases_.clear();
  for (auto& readings : readings_)
    readings.clear();
}

void PressureMonitor::forgetBefore(double time)
{
  while (!phases_.empty() && phases_.front().first < time)
    phases_.pop_front();
  for (auto& readings : readings_)
    while (!readings.empty() && readings.front().first < time)
      readings.pop_front();
}

void PressureMonitor::add(const sensor_msgs::FluidPressure& reading)
{
  const auto found = std::find(frames_.begin(), frames_.end(), reading.header.frame_id);
  if (found == frames_.end() || !std::isfinite(reading.fluid_pressure))
    return;
  const double time = reading.header.stamp.toSec();
  restartAfterFall(time);
  auto& readings = readings_[static_cast<std::size_t>(found - frames_.begin())];
  if (readings.empty() || time > readings.back().first)
    readings.emplace_back(time, reading.fluid_pressure);
  forgetBefore(time - kDuration);
}

void PressureMonitor::add(const HeartPhase& heart)
{
  if (!std::isfinite(heart.phase))
    return;
  const double time = heart.header.stamp.toSec();
  restartAfterFall(time);
  heart_ = heart;
  if (phases_.empty() || time > phases_.back().first)
    phases_.emplace_back(time, heart.phase);
  forgetBefore(time - kDuration);
}

std::optional<BloodState> PressureMonitor::state() const
{
  if (!heart_)
    return std::nullopt;
  BloodState state;
  state.time = heart_->header.stamp.toSec();
  state.heart_rate = heart_->heart_rate;
  state.mean_pressure = heart_->mean_pressure;
  state.hyperaemia = heart_->hyperaemia != 0;
  state.phases.assign(phases_.begin(), phases_.end());
  const double since = state.time - (heart_->heart_rate > 0.0 ? kSpan / heart_->heart_rate : kDuration);
  for (std::size_t k = 0; k < readings_.size(); ++k)
  {
    PressureTrace& line = state.lines.emplace_back();
    line.name = names_[k];
    line.readings.assign(readings_[k].begin(), readings_[k].end());
    for (const auto& [time, pressure] : line.readings)
      if (time >= since)
      {
        line.highest = std::fmax(line.highest, pressure);
        line.lowest = std::fmin(line.lowest, pressure);
      }
    if (heart_->mean_readings.size() == readings_.size() && heart_->mean_root_pressure > 0.0)
      line.mean = heart_->mean_readings[k];
  }
  if (state.lines.size() < 2)
    return state;
  const double behind = state.lines.front().mean, before = state.lines.back().mean;
  if (behind > kLeastPressure && before > kLeastPressure)
    state.ratio = behind / before;
  state.is_reserve = heart_->mean_hyperaemia != 0;
  return state;
}

}  // namespace endovascular_sim::rviz_plugin
