#include "rviz_plugin/model/motion_monitor.h"

#include <cmath>

#include "common/error.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::rviz_plugin
{

void MotionMonitor::add(const MotionState& message)
{
  if (!std::isfinite(message.heart_rate) || !std::isfinite(message.breathing_rate))
    throw InputError(nodes::names::kMotionState, "heart_rate, breathing_rate", "must be finite");
  map_ = nodes::fromMessage(message);
  without_ = 0;
  MotionStatus& status = status_.emplace();
  const bool is_held = message.breath_held != 0;
  status.controls = controls_.value_or(motion::MotionControls{message.heart_rate, message.breathing_rate, is_held});
  status.heart_rate = message.heart_rate;
  status.systole = message.systole != 0;
  status.is_holding = is_held;
}

void MotionMonitor::add(const MotionControls& message)
{
  controls_ = nodes::fromMessage(message);
  if (status_)
    status_->controls = *controls_;
}

void MotionMonitor::countWire()
{
  if (status_ && ++without_ > kMostWithout)
    *this = MotionMonitor();
}

Eigen::Vector3d MotionMonitor::pullBack(const Eigen::Vector3d& moved) const
{
  return map_ ? map_->pullBack(moved) : moved;
}

}  // namespace endovascular_sim::rviz_plugin
