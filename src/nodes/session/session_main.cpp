#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"
#include "nodes/session/session_node.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"session"},
                 [](ros::NodeHandle& node, const SchedulingRequest& /*request*/)
                 {
                   SessionNode session(node, ros::NodeHandle("~"), sceneFromParameters(node));
                   return session.run();
                 });
}
