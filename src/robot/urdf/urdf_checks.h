#pragma once

#include <string>
#include <vector>

#include "robot/robot_model.h"

class TiXmlDocument;
class TiXmlElement;

namespace endovascular_sim::robot
{

/** Checks the XML of a URDF before urdfdom reads it: syntax, numbers, links of each joint, and the tree of the links.
 *  @throws InputError naming file, line and joint */
void checkXml(const TiXmlDocument& document, const std::string& file);

/** Refuses the axis zero, which has no direction. */
void checkAxis(const Joint& joint, double x, double y, double z, const std::string& file);

/** Checks limits and mimics of all joints. @throws InputError naming file, joint and remedy */
void checkJoints(const RobotModel& model);

/** Warnings of parts that have no effect here: transmissions, and mesh files that do not exist. */
std::vector<std::string> xmlWarnings(const TiXmlElement& root, const std::string& file);

/** Warnings of joints whose range of many turns suggests limits in degrees. */
std::vector<std::string> rangeWarnings(const RobotModel& model);

/** Name of a joint in messages: "joint 'x' (line 7)". */
std::string nameOf(const Joint& joint);

}  // namespace endovascular_sim::robot
