#include <ros/ros.h>

#include "nodes/expert/expert_node.h"
#include "nodes/runtime/node_program.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"expert"},
                 [](ros::NodeHandle& node, const SchedulingRequest& /*request*/)
                 {
                   const ExpertNode expert(node, ros::NodeHandle("~"));
                   ros::spin();
                   return true;
                 });
}
