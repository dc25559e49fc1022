#include "robot/ros_package.h"

#include <cstdlib>
#include <sstream>

namespace endovascular_sim::robot
{
namespace fs = std::filesystem;

namespace
{

constexpr int kLevels = 3;  // folders between one of ROS_PACKAGE_PATH and a package in a workspace

fs::path findBelow(const fs::path& folder, const std::string& name, int levels)
{
  std::error_code error;
  if (folder.filename() == name && fs::is_regular_file(folder / "package.xml", error))
    return folder;
  if (fs::is_regular_file(folder / name / "package.xml", error))
    return folder / name;
  // A package holds no other packages.
  if (levels == 0 || fs::is_regular_file(folder / "package.xml", error))
    return {};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.is_directory(error) && entry.path().filename().string().front() != '.')
      if (fs::path found = findBelow(entry.path(), name, levels - 1); !found.empty())
        return found;
  return {};
}

}  // namespace

std::optional<fs::path> findRosPackage(const std::string& name)
{
  const char* folders = std::getenv("ROS_PACKAGE_PATH");
  if (folders == nullptr || *folders == '\0')
    return std::nullopt;
  std::istringstream list(folders);
  for (std::string folder; !name.empty() && std::getline(list, folder, ':');)
    if (!folder.empty())
      if (fs::path found = findBelow(folder, name, kLevels); !found.empty())
        return found;
  return fs::path();
}

}  // namespace endovascular_sim::robot
