#include <ros/ros.h>

#include "common/error.h"
#include "nodes/rod_dynamics/rod_loop.h"
#include "nodes/runtime/real_time.h"
#include "nodes/runtime/scene_parameters.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim;  // NOLINT: a program's main file
  constexpr int kPriority = 70;
  const nodes::RealTimeGrant grant = nodes::askForRealTime(kPriority);
  ros::init(argc, argv, "rod_dynamics");
  ros::NodeHandle node;
  if (grant.granted)
    ROS_INFO("rod_dynamics: %s", grant.message.c_str());
  else
    ROS_WARN("rod_dynamics: %s", grant.message.c_str());
  try
  {
    nodes::RodLoop loop(node, nodes::sceneFromParameters(node), grant);
    return loop.run() ? 0 : 1;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("rod_dynamics: %s", error.what());
    return 1;
  }
}
