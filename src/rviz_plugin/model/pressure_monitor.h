#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sensor_msgs/FluidPressure.h>

#include "endovascular_sim/HeartPhase.h"

namespace endovascular_sim::rviz_plugin
{

/** Pressure line of an instrument, as the panel shows it. */
struct PressureTrace
{
  std::string name;                                 ///< of the instrument
  std::vector<std::pair<double, double>> readings;  ///< time [s] and pressure [Pa] of the last seconds, ascending
  double highest = std::numeric_limits<double>::quiet_NaN();  ///< of the last beat or more [Pa]
  double lowest = std::numeric_limits<double>::quiet_NaN();   ///< the same [Pa]
  double mean = std::numeric_limits<double>::quiet_NaN();     ///< of the last complete beat [Pa]
};

/** What the panel knows of the blood. */
struct BloodState
{
  std::vector<PressureTrace> lines;               ///< from the innermost instrument out
  std::vector<std::pair<double, double>> phases;  ///< time [s] and phase of the heart, as the readings
  double time = 0.0;                              ///< of the newest message [s]
  double heart_rate = 0.0;                        ///< [Hz]
  double mean_pressure = 0.0;                     ///< that the circulation aims at [Pa]
  bool hyperaemia = false;
  /** Mean of the innermost line divided by that of the outermost one; none unless both are in the vessel. */
  std::optional<double> ratio;
  bool is_reserve = false;  ///< true: the ratio is of a beat in hyperaemia
};

/** Keeps the last seconds of the pressure lines and of the phase of the heart. */
class PressureMonitor
{
public:
  static constexpr double kDuration = 4.0;  ///< of the traces [s]

  /** @param names, frames of the instruments with pressure lines, from the inside out */
  void setLines(const std::vector<std::string>& names, std::vector<std::string> frames);

  /** Adds a reading; one of an unknown frame is ignored. A fall of the time begins again. */
  void add(const sensor_msgs::FluidPressure& reading);
  void add(const HeartPhase& heart);

  /** None before the first message of the heart. */
  std::optional<BloodState> state() const;

private:
  void forgetBefore(double time);
  void restartAfterFall(double time);

  std::vector<std::string> frames_;
  std::vector<std::string> names_;
  std::vector<std::deque<std::pair<double, double>>> readings_;
  std::deque<std::pair<double, double>> phases_;
  std::optional<HeartPhase> heart_;
};

/** Voltage of an electrocardiogram with waves P, QRS and T, relative to that of R. Its R wave comes before the opening
 * of the aortic valve by the duration of the isovolumic contraction.
 *  @param phase of the beat, from 0 at the opening of the aortic valve to 1 */
double electrocardiogram(double phase);

}  // namespace endovascular_sim::rviz_plugin
