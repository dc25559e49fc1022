#include <optional>

#include <ros/ros.h>

#include "nodes/robot/robot_node.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim;         // NOLINT: a program's main file
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"robot"},
                 [](ros::NodeHandle& node, const SchedulingRequest& request)
                 {
                   const scene::Scene scene = sceneFromParameters(node);
                   request();
                   std::optional<RobotNode> robot;
                   if (scene.robot)
                     robot.emplace(node, scene);
                   else
                     ROS_INFO("no robot in the scene %s: nothing to do", scene.name.c_str());
                   ros::spin();
                   return true;
                 });
}
