#include <optional>

#include <ros/ros.h>

#include "nodes/fluoroscopy/fluoroscopy_node.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim;         // NOLINT: a program's main file
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"fluoroscopy", NodeScheduling::kIdle},
                 [](ros::NodeHandle& node, const SchedulingRequest& request)
                 {
                   const scene::Scene scene = sceneFromParameters(node);
                   std::optional<FluoroscopyNode> fluoroscopy;
                   if (scene.fluoroscopy)
                     fluoroscopy.emplace(node, ros::NodeHandle("~"), scene, request);
                   else
                     ROS_INFO("no fluoroscopy in the scene %s: nothing to do", scene.name.c_str());
                   ros::spin();
                   return true;
                 });
}
