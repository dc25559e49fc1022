#include "nodes/rod_dynamics/rod_dynamics_node.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"rod_dynamics", NodeScheduling::kLockStep, 70},
                 [](ros::NodeHandle& node, const SchedulingRequest& request)
                 {
                   RodDynamicsNode rod(node, ros::NodeHandle("~"), sceneWithLoggedWarnings(node), request);
                   return rod.run();
                 });
}
