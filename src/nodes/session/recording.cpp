#include "nodes/session/recording.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/error.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kJointRate = 100.0;   ///< rate of setpoint_js in the bag [Hz]
constexpr double kContactRate = 30.0;  ///< rate of contact/forces in the bag [Hz]

}  // namespace

Recording::Recording(const scene::Scene& scene, std::string folder_, std::uint64_t steps_, const std::string& bag_name)
  : folder(std::move(folder_)),
    steps(steps_),
    bag(path(bag_name)),
    results(scene, folder, steps),
    pose(scene.record.pose_rate),
    joints(kJointRate),
    contacts(kContactRate),
    heart(kHeartRate),
    flow(kFlowRate)
{
}

std::uint64_t nextFrame(const std::string& folder)
{
  std::uint64_t next = 0;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/fluoroscopy", missing))
  {
    unsigned long long number = 0;
    if (std::sscanf(entry.path().filename().c_str(), "frame_%llu.png", &number) == 1)
      next = std::max<std::uint64_t>(next, number + 1);
  }
  return next;
}

std::string createRecordingFolder(const std::string& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder + "/fluoroscopy", error);
  if (error)
    throw InputError(folder, "results", "the folder cannot be created (" + error.message() + "); choose another one");
  for (const char* name : {"/session.bag", "/report.json"})
    if (std::filesystem::exists(folder + name))
      throw InputError(folder, "results", "the folder already contains a session; choose another one");
  return folder;
}

}  // namespace endovascular_sim::nodes
