#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace endovascular_sim::robot
{

/** Folder of a ROS package, searched in the folders of ROS_PACKAGE_PATH and three levels below them.
 *  @return empty path: no such package; no value: ROS_PACKAGE_PATH is not set */
std::optional<std::filesystem::path> findRosPackage(const std::string& name);

}  // namespace endovascular_sim::robot
