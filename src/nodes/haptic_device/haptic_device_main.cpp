#include "nodes/haptic_device/haptic_device_node.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  // The lowest real-time priority: above ordinary threads, below those of the simulation.
  return runNode(argc, argv, {"haptic_device", NodeScheduling::kRealTime, 1},
                 [](ros::NodeHandle& node, const SchedulingRequest& request)
                 {
                   HapticDeviceNode device(node, ros::NodeHandle("~"), sceneFromParameters(node));
                   device.setScheduling(request());
                   spinUntilShutdown();
                   return true;
                 });
}
