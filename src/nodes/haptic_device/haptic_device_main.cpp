#include <optional>

#include "nodes/haptic_device/haptic_device_node.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/scene_parameters.h"

int main(int argc, char** argv)
{
  using namespace endovascular_sim;         // NOLINT: a program's main file
  using namespace endovascular_sim::nodes;  // NOLINT: a program's main file
  // The lowest real-time priority: above ordinary threads, below those of the simulation.
  return runNode(argc, argv, {"haptic_device", NodeScheduling::kRealTime, 1},
                 [](ros::NodeHandle& node, const SchedulingRequest& request)
                 {
                   const scene::Scene scene = sceneFromParameters(node);
                   std::optional<HapticDeviceNode> device;
                   if (scene.haptic_device)
                   {
                     device.emplace(node, ros::NodeHandle("~"), scene);
                     device->setScheduling(request());
                   }
                   else
                     ROS_INFO("no haptic device in the scene %s: nothing to do", scene.name.c_str());
                   spinUntilShutdown();
                   return true;
                 });
}
