#pragma once

#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/JointState.h>

#include "robot/robot_control.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Values of an instrument's motions from the joints of its messages; 0 for a joint that it lacks.
 *  @param values positions, velocities or efforts of the message */
robot::Motions motionsOf(const sensor_msgs::JointState& message, const std::vector<double>& values);

/** Command to an instrument, without names: insertion, rotation and pressure in this order. A pressure needs a
 *  rotation. */
sensor_msgs::JointState toMessage(const drive::JointCommand& command);

/** Joints of the robot's links from the joints of its instruments: positions and velocities through the inverse ratio,
 *  efforts through its transpose. Velocities and efforts remain empty if the instruments have none.
 *  @param instruments messages, one per instrument of the control, of one step */
void toMessage(const robot::RobotControl& control, const std::vector<sensor_msgs::JointState>& instruments,
               sensor_msgs::JointState& joints);

/** All movable joints from those of the links, for robot_state_publisher. */
void toAllJoints(const robot::RobotControl& control, const sensor_msgs::JointState& linked,
                 sensor_msgs::JointState& all);

/** Where the robot stands: transform of its root link to its frame. */
geometry_msgs::TransformStamped toTransform(const scene::RobotScene& robot);

/** Control of a scene's robot. */
robot::RobotControl robotControl(const scene::Scene& scene);

}  // namespace endovascular_sim::nodes
