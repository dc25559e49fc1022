#pragma once

#include <optional>

#include <Eigen/Core>

#include "endovascular_sim/MotionControls.h"
#include "endovascular_sim/MotionState.h"
#include "motion/map/motion_map.h"
#include "motion/motion_controls.h"

namespace endovascular_sim::rviz_plugin
{

/** What the panel knows of heart and breath. */
struct MotionStatus
{
  motion::MotionControls controls;  ///< from the next beat and breath on
  double heart_rate = 0.0;          ///< of the present beat; 0: arrest [Hz]
  bool systole = false;
  bool is_holding = false;  ///< the breath is held, at the end of an expiration
};

/** Keeps the motion of the patient for the panel. */
class MotionMonitor
{
public:
  static constexpr int kMostWithout = 120;  ///< states without a motion, after which the patient is at rest

  /** @throws InputError for impossible values @{ */
  void add(const MotionState& message);
  void add(const MotionControls& message);
  /** @} */
  /** Counts a state of the instruments. */
  void countWire();

  /** None without motion. */
  const std::optional<MotionStatus>& status() const { return status_; }
  /** Place in the resting patient. @param moved a point at the time of the newest motion [m] */
  Eigen::Vector3d pullBack(const Eigen::Vector3d& moved) const;

private:
  std::optional<MotionStatus> status_;
  std::optional<motion::MotionMap> map_;
  std::optional<motion::MotionControls> controls_;
  int without_ = 0;  ///< states since the last motion
};

}  // namespace endovascular_sim::rviz_plugin
