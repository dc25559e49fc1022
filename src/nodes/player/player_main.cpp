#include <string>
#include <vector>

#include <ros/ros.h>

#include "nodes/player/player_node.h"
#include "nodes/runtime/node_program.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  std::vector<std::string> arguments;
  for (int k = 1; k < argc; ++k)
    if (std::string(argv[k]).find(":=") == std::string::npos)  // others are those of ROS
      arguments.emplace_back(argv[k]);
  return runNode(argc, argv, {"player"},
                 [&arguments](ros::NodeHandle& node, const SchedulingRequest& /*request*/)
                 {
                   const PlayerNode player(node, playerSettings(ros::NodeHandle("~"), arguments));
                   ros::spin();
                   return true;
                 });
}
