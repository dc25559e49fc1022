#include <ros/ros.h>

#include "nodes/runtime/node_program.h"
#include "nodes/visualization/visualization_node.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"visualization"},
                 [](ros::NodeHandle& node, const SchedulingRequest& /*request*/)
                 {
                   const VisualizationNode visualization(node, ros::NodeHandle("~"));
                   ros::spin();
                   return true;
                 });
}
