#include "nodes/conversions/motion_conversions.h"

#include <cmath>
#include <string>

#include "common/error.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kUnit = 1e-6;  // error of the length of a unit vector

/** Message of type geometry_msgs/Point or geometry_msgs/Vector3. */
template <typename Message>
Message toXyz(const Eigen::Vector3d& v)
{
  Message message;
  message.x = v.x(), message.y = v.y(), message.z = v.z();
  return message;
}

template <typename Message>
Eigen::Vector3d fromXyz(const Message& message)
{
  return {message.x, message.y, message.z};
}

template <typename Linear>
void toMessage(const motion::MotionField& field, geometry_msgs::Vector3& shift, Linear& linear, double& twist)
{
  shift = toXyz<geometry_msgs::Vector3>(field.shift);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      linear[static_cast<std::size_t>(3 * i + j)] = field.linear(i, j);
  twist = field.twist;
}

template <typename Linear>
motion::MotionField fieldOf(const geometry_msgs::Vector3& shift, const Linear& linear, double twist, const char* key)
{
  motion::MotionField field;
  field.shift = fromXyz(shift);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      field.linear(i, j) = linear[static_cast<std::size_t>(3 * i + j)];
  field.twist = twist;
  if (!field.shift.allFinite() || !field.linear.allFinite() || !std::isfinite(twist))
    throw InputError(names::kMotionState, key, "must be finite");
  return field;
}

}  // namespace

void toMessage(const motion::MovingPatient& patient, MotionState& message)
{
  const motion::MotionMap& map = patient.map();
  const motion::HeartFrame& frame = map.frame();
  message.heart_phase = patient.heart().phase();
  message.heart_rate = patient.heart().rate();
  message.systole = patient.systole() ? 1 : 0;
  message.breath_phase = patient.breath().phase();
  message.breathing_rate = patient.breath().rate();
  message.breath_held = patient.breath().standing() ? 1 : 0;
  message.diaphragm = patient.diaphragm();
  message.fade_centre = toXyz<geometry_msgs::Point>(frame.fade.centre);
  message.fade_core = frame.fade.core;
  message.fade_reach = frame.fade.reach;
  message.base = toXyz<geometry_msgs::Point>(frame.base);
  message.axis = toXyz<geometry_msgs::Vector3>(frame.axis);
  message.length = frame.length;
  toMessage(map.field(), message.shift, message.linear, message.twist);
  toMessage(map.rate(), message.shift_rate, message.linear_rate, message.twist_rate);
}

motion::MotionMap fromMessage(const MotionState& message)
{
  motion::HeartFrame frame;
  frame.base = fromXyz(message.base);
  frame.axis = fromXyz(message.axis);
  frame.length = message.length;
  frame.fade.centre = fromXyz(message.fade_centre);
  frame.fade.core = message.fade_core;
  frame.fade.reach = message.fade_reach;
  if (!frame.base.allFinite() || !(std::abs(frame.axis.norm() - 1.0) < kUnit) || !std::isfinite(frame.length))
    throw InputError(names::kMotionState, "axis", "must be a unit vector from a finite base");
  if (!frame.fade.centre.allFinite() || !(frame.fade.core >= 0.0) || !(frame.fade.reach > frame.fade.core) ||
      !std::isfinite(frame.fade.reach))
    throw InputError(names::kMotionState, "fade_reach", "must be finite, and larger than fade_core");
  return {frame, fieldOf(message.shift, message.linear, message.twist, "shift, linear, twist"),
          fieldOf(message.shift_rate, message.linear_rate, message.twist_rate, "shift_rate, linear_rate, twist_rate")};
}

void toMessage(const motion::MotionControls& controls, MotionControls& message)
{
  message.heart_rate = controls.heart_rate;
  message.breathing_rate = controls.breathing_rate;
  message.breath_held = controls.breath_held ? 1 : 0;
}

motion::MotionControls fromMessage(const MotionControls& message)
{
  const motion::MotionControls controls{message.heart_rate, message.breathing_rate, message.breath_held != 0};
  const std::string refusal = motion::refusalOf(controls);
  if (!refusal.empty())
    throw InputError(names::kMotionControls, "", refusal);
  return controls;
}

}  // namespace endovascular_sim::nodes
