#include "nodes/session/session_node.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <sstream>
#include <string>

#include "common/error.h"
#include "common/file/file_name.h"
#include "common/text/one_line.h"
#include "nodes/runtime/node_shutdown.h"
#include "nodes/runtime/parameters.h"
#include "nodes/runtime/scene_parameters.h"
#include "nodes/session/session_parameters.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Interval of message processing; batches avoid a wake-up per message. */
constexpr double kPeriod = 5e-3;  // s

/** Longest wait for the end of the graph. */
constexpr double kEndOfGraph = 30.0;  // s

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

/** Finds the recording that a process before this one has left on the parameter server. */
void findRecording(const ros::NodeHandle& parameters, RecorderSettings& settings)
{
  settings.continues = parameters.param("continue", false) &&
                       parameters.getParam(session_parameters::kFolder, settings.folder) &&
                       parameters.getParam(session_parameters::kRunFolder, settings.run_folder);
  if (settings.continues)
  {
    settings.run = static_cast<std::uint32_t>(std::max(parameters.param(session_parameters::kRun, 0), 0));
    settings.is_stopped = parameters.param(session_parameters::kStopped, false);
  }
}

/** Subject of the parameter, else of the scene.
 *  @throws InputError for one that is no line of text */
std::string subjectFrom(const ros::NodeHandle& node, const ros::NodeHandle& parameters)
{
  const std::string subject = parameters.param<std::string>("subject", "");
  if (!isOneLine(subject))
    throw InputError(
        "parameter server", parameters.resolveName("subject"),
        "must be one line of at most " + std::to_string(kLongestLine) + " bytes in UTF-8, without control characters");
  return subject.empty() ? subjectFromParameters(node) : subject;
}

RecorderSettings settingsFrom(const ros::NodeHandle& node, const ros::NodeHandle& parameters,
                              const std::string& scene_name)
{
  RecorderSettings settings;
  settings.subject = subjectFrom(node, parameters);
  settings.folder = parameters.param<std::string>("results", "");
  if (settings.folder.empty())
    settings.folder = defaultFolder(scene_name);
  settings.stop_at_duration = parameters.param("stop_at_duration", settings.stop_at_duration);
  settings.patience = numericParameter(parameters, "patience", settings.patience, quantities::kWait);
  settings.start_patience =
      numericParameter(parameters, "start_patience", settings.start_patience, quantities::kDuration);
  settings.picture_interval = parameters.param("picture_interval", settings.picture_interval);
  findRecording(parameters, settings);
  parameters.setParam(session_parameters::kFolder, settings.folder);
  return settings;
}

}  // namespace

SessionNode::SessionNode(const ros::NodeHandle& node, const ros::NodeHandle& parameters, const scene::Scene& scene)
  : ends_graph_(parameters.param("ends_graph", false)),
    recorder_(node, scene, settingsFrom(node, parameters, scene.name))
{
}

/** Ends the graph: rod_dynamics is required by the launch file, this node is started again by it. */
void SessionNode::endGraph() const
{
  if (!ends_graph_ || !shutDownNode("rod_dynamics", "the session has ended", 1.0))
    return;
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(kEndOfGraph);
  while (ros::ok() && stop_signal == 0 && ros::SteadyTime::now() < end)
    ros::WallDuration(kPeriod).sleep();
}

bool SessionNode::run()
{
  // Messages that have already arrived are still recorded. The handler of ROS drops them, and handles SIGINT only.
  for (const int signal : {SIGINT, SIGTERM})
    std::signal(signal, [](int) { stop_signal = 1; });
  while (ros::ok() && stop_signal == 0 && !recorder_.isOver())
  {
    ros::spinOnce();
    recorder_.update();
    ros::WallDuration(kPeriod).sleep();
  }
  ros::spinOnce();
  const bool is_complete = recorder_.finish();
  if (recorder_.isOver())
    endGraph();
  return is_complete;
}

}  // namespace endovascular_sim::nodes
