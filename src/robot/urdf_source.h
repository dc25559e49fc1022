#pragma once

#include <string>

#include "robot/robot_model.h"

namespace endovascular_sim::robot
{

/** Reads a URDF file. Programs that link `robot/urdf` (installed: endovascular_sim::robot) can; others load no URDF
 *  library.
 *  @throws InputError naming file, joint and remedy; in a program that cannot read URDF files, naming what to link */
RobotModel loadUrdf(const std::string& file);

using UrdfReader = RobotModel (*)(const std::string& file);

/** Sets the reader of loadUrdf(), before main(). */
bool registerUrdfReader(UrdfReader reader);

}  // namespace endovascular_sim::robot
