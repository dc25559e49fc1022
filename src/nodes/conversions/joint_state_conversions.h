#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include <sensor_msgs/JointState.h>

#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

/** Index of a joint by its name; none if the message lacks it. Without any names, which CRTK allows, the joints are
 *  insertion, rotation[, pressure] in this order. */
inline std::optional<std::size_t> jointOf(const sensor_msgs::JointState& message, const std::string& name)
{
  if (message.name.empty())
    return name == names::kInsertionJoint ? 0U : name == names::kRotationJoint ? 1U : 2U;
  const auto joint = std::find(message.name.begin(), message.name.end(), name);
  if (joint == message.name.end())
    return std::nullopt;
  return static_cast<std::size_t>(joint - message.name.begin());
}

/** Converts the command and the rendered force of one instrument to the joints of CRTK.
 *  @param insertion, rotation, pressure command in use [m], [rad], [Pa]
 *  @param force, torque rendered to the hand [N], [N·m] */
inline void toMessage(bool has_balloon, double insertion, double rotation, double pressure, double force, double torque,
                      sensor_msgs::JointState& message)
{
  message.name = {names::kInsertionJoint, names::kRotationJoint};
  message.position = {insertion, rotation};
  message.effort = {force, torque};
  if (!has_balloon)
    return;
  message.name.emplace_back(names::kPressureJoint);
  message.position.push_back(pressure);
  message.effort.push_back(0.0);
}

}  // namespace endovascular_sim::nodes
