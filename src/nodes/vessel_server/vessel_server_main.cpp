#include <ros/ros.h>

#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"
#include "nodes/vessel_server/vessel_server_node.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"vessel_server"},
                 [](ros::NodeHandle& node, const SchedulingRequest& /*request*/)
                 {
                   const VesselServerNode server(node, sceneFromParameters(node));
                   ros::spin();
                   return true;
                 });
}
