#include "nodes/hemodynamics/hemodynamics_node.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  return runNode(argc, argv, {"hemodynamics", NodeScheduling::kLockStep, 50},
                 [](ros::NodeHandle& node, const SchedulingRequest& request)
                 {
                   const HemodynamicsNode hemodynamics(node, sceneFromParameters(node), request);
                   spinUntilShutdown();
                   return true;
                 });
}
