#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

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

/** Values of the joints of one instrument. */
struct JointValues
{
  double insertion = 0.0;
  double rotation = 0.0;
  double pressure = 0.0;
};

/** Sets names of joints and their values. */
inline void setJoints(bool has_balloon, const JointValues& joints, std::vector<double>& values,
                      std::vector<std::string>& names)
{
  names = {names::kInsertionJoint, names::kRotationJoint};
  values = {joints.insertion, joints.rotation};
  if (!has_balloon)
    return;
  names.emplace_back(names::kPressureJoint);
  values.push_back(joints.pressure);
}

/** Converts positions and efforts of one instrument to the joints of CRTK.
 *  @param force, torque [N], [N·m] */
inline void toMessage(bool has_balloon, const JointValues& joints, double force, double torque,
                      sensor_msgs::JointState& message)
{
  setJoints(has_balloon, joints, message.position, message.name);
  message.effort = {force, torque};
  if (has_balloon)
    message.effort.push_back(0.0);
}

}  // namespace endovascular_sim::nodes
