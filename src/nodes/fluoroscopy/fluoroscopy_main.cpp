#include <ros/ros.h>

#include "nodes/fluoroscopy/fluoroscopy_node.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"fluoroscopy", NodeScheduling::kIdle},
                 [](ros::NodeHandle& node, const SchedulingRequest& request)
                 {
                   const FluoroscopyNode fluoroscopy(node, ros::NodeHandle("~"), sceneFromParameters(node), request());
                   ros::spin();
                   return true;
                 });
}
