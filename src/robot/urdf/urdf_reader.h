#pragma once

#include <string>

#include "robot/robot_model.h"

namespace endovascular_sim::robot
{

/** Reads a URDF with urdfdom, and checks what urdfdom accepts silently: limits in the wrong order or negative, a joint
 *  without an axis, mimics of missing joints or in a ring, a link with two parents or none. Elements may be nested 64
 *  deep; a robot may have 500 links.
 *  @throws InputError naming file, joint and remedy */
RobotModel readUrdf(const std::string& file);

/** The same for a text.
 *  @param file name of the text in errors, and folder of mesh files without one */
RobotModel parseUrdf(const std::string& text, const std::string& file);

}  // namespace endovascular_sim::robot
