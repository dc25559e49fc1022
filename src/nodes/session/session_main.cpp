#include <memory>
#include <string>

#include <ros/ros.h>

#include "common/error.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/node_shutdown.h"
#include "nodes/runtime/scene_parameters.h"
#include "nodes/session/session_node.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

constexpr double kStart = 10.0;       ///< longest wait for the start of rod_dynamics [s]
constexpr double kEndOfGraph = 30.0;  ///< longest wait for the end of the graph [s]

/** Ends the graph of a session that cannot be recorded: the launch file would start this node again and again.
 *  @return false when the graph goes on */
bool endGraph(const std::string& reason)
{
  if (!ros::param::param("~ends_graph", false))
    return false;
  ROS_FATAL("%s", reason.c_str());
  if (!nodes::shutDownNode("rod_dynamics", "the session cannot be recorded", kStart))
    return false;
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(kEndOfGraph);
  while (ros::ok() && ros::SteadyTime::now() < end)
    ros::WallDuration(0.1).sleep();
  return true;
}

bool run(ros::NodeHandle& node)
{
  std::unique_ptr<nodes::SessionNode> session;
  try
  {
    session = std::make_unique<nodes::SessionNode>(node, ros::NodeHandle("~"), nodes::sceneFromParameters(node));
  }
  catch (const InputError& error)
  {
    if (!endGraph(error.what()))
      throw;
    return false;
  }
  return session->run();
}

}  // namespace

int main(int argc, char** argv)
{
  return nodes::runNode(argc, argv, {"session"},
                        [](ros::NodeHandle& node, const nodes::SchedulingRequest& /*request*/) { return run(node); });
}
