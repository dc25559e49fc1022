#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <sstream>

#include <ros/ros.h>

#include "common/error.h"
#include "nodes/runtime/real_time.h"
#include "nodes/runtime/scene_parameters.h"
#include "nodes/session/session_recorder.h"

namespace
{

/** Between two looks at what has come: not a wake-up per message. */
constexpr double kTurn = 5e-3;  // s

volatile std::sig_atomic_t stop_signal = 0;

using endovascular_sim::nodes::RecorderSettings;

/** Folder below ROS_HOME for a session that was given none. */
std::string defaultFolder(const std::string& scene_name)
{
  const char* ros_home = std::getenv("ROS_HOME");
  const char* home = std::getenv("HOME");
  std::ostringstream folder;
  folder << (ros_home != nullptr ? std::string(ros_home) : std::string(home != nullptr ? home : ".") + "/.ros");
  const std::time_t now = std::time(nullptr);
  folder << "/endovascular_sim/" << scene_name << "-" << std::put_time(std::localtime(&now), "%Y%m%d-%H%M%S");
  return folder.str();
}

RecorderSettings settingsFrom(const ros::NodeHandle& parameters, const std::string& scene_name)
{
  RecorderSettings settings;
  settings.folder = parameters.param<std::string>("results", "");
  if (settings.folder.empty())
    settings.folder = defaultFolder(scene_name);
  settings.stop_at_duration = parameters.param("stop_at_duration", settings.stop_at_duration);
  settings.patience = parameters.param("patience", settings.patience);
  settings.start_patience = parameters.param("start_patience", settings.start_patience);
  settings.picture_interval = parameters.param("picture_interval", settings.picture_interval);
  return settings;
}

}  // namespace

int main(int argc, char** argv)
{
  endovascular_sim::nodes::keepOffLockStepCpu();
  ros::init(argc, argv, "session");
  ros::NodeHandle node;
  // What has come by then is still recorded; ROS's own handler drops it, and knows SIGINT only.
  for (const int signal : {SIGINT, SIGTERM})
    std::signal(signal, [](int) { stop_signal = 1; });
  try
  {
    const auto scene = endovascular_sim::nodes::sceneFromParameters(node);
    endovascular_sim::nodes::SessionRecorder recorder(node, scene, settingsFrom(ros::NodeHandle("~"), scene.name));
    while (ros::ok() && stop_signal == 0)
    {
      ros::spinOnce();
      ros::WallDuration(kTurn).sleep();
    }
    ros::spinOnce();
    return recorder.finish() ? 0 : 1;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
