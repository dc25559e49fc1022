#pragma once

#include <optional>

#include "endovascular_sim/ContrastState.h"

namespace endovascular_sim::rviz_plugin
{

/** What the panel knows of contrast medium. */
struct ContrastStatus
{
  double rate = 0.0;       ///< of the present injection; 0: none [m³/s]
  double remaining = 0.0;  ///< of the present injection [m³]
  double syringe = 0.0;    ///< what it holds [m³]
  double volume = 0.0;     ///< injected since the beginning of the run [m³]
};

/** Keeps the state of contrast medium for the panel. */
class ContrastMonitor
{
public:
  static constexpr int kMostWithout = 120;  ///< states without one of contrast medium, after which there is none

  /** @throws InputError for numbers that are not finite or negative */
  void add(const ContrastState& message);
  /** Counts a state of the instruments. */
  void countWire();

  /** None in a scene without contrast medium. */
  const std::optional<ContrastStatus>& status() const { return status_; }

private:
  std::optional<ContrastStatus> status_;
  int without_ = 0;  ///< states since the last one of contrast medium
};

}  // namespace endovascular_sim::rviz_plugin
