#include "nodes/session/session_node.h"

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <sstream>
#include <string>

#include "common/file/file_name.h"
#include "nodes/runtime/parameters.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Interval of message processing; batches avoid a wake-up per message. */
constexpr double kPeriod = 5e-3;  // s

volatile std::sig_atomic_t stop_signal = 0;

/** Default folder of the results, always a direct subfolder of ROS_HOME/endovascular_sim. */
std::string defaultFolder(const std::string& scene_name)
{
  const char* ros_home = std::getenv("ROS_HOME");
  const char* home = std::getenv("HOME");
  std::ostringstream folder;
  folder << (ros_home != nullptr ? std::string(ros_home) : std::string(home != nullptr ? home : ".") + "/.ros");
  const std::time_t now = std::time(nullptr);
  folder << "/endovascular_sim/" << fileNameOf(scene_name) << "-"
         << std::put_time(std::localtime(&now), "%Y%m%d-%H%M%S");
  return folder.str();
}

RecorderSettings settingsFrom(const ros::NodeHandle& parameters, const std::string& scene_name)
{
  RecorderSettings settings;
  settings.folder = parameters.param<std::string>("results", "");
  if (settings.folder.empty())
    settings.folder = defaultFolder(scene_name);
  settings.stop_at_duration = parameters.param("stop_at_duration", settings.stop_at_duration);
  settings.patience = numericParameter(parameters, "patience", settings.patience, quantities::kWait);
  settings.start_patience =
      numericParameter(parameters, "start_patience", settings.start_patience, quantities::kDuration);
  settings.picture_interval = parameters.param("picture_interval", settings.picture_interval);
  return settings;
}

}  // namespace

SessionNode::SessionNode(const ros::NodeHandle& node, const ros::NodeHandle& parameters, const scene::Scene& scene)
  : recorder_(node, scene, settingsFrom(parameters, scene.name))
{
}

bool SessionNode::run()
{
  // Messages that have already arrived are still recorded. The handler of ROS drops them, and handles SIGINT only.
  for (const int signal : {SIGINT, SIGTERM})
    std::signal(signal, [](int) { stop_signal = 1; });
  while (ros::ok() && stop_signal == 0)
  {
    ros::spinOnce();
    recorder_.update();
    ros::WallDuration(kPeriod).sleep();
  }
  ros::spinOnce();
  return recorder_.finish();
}

}  // namespace endovascular_sim::nodes
