#include "nodes/runtime/scene_parameters.h"

#include <iterator>
#include <sstream>

#include <ros/console.h>

#include "common/error.h"
#include "nodes/runtime/ros_names.h"
#include "scene/scene_file.h"

namespace endovascular_sim::nodes
{

scene::Scene sceneFromParameters(const ros::NodeHandle& node)
{
  std::string file;
  if (!node.getParam(names::kSceneParameter, file))
    throw InputError("parameter server", node.resolveName(names::kSceneParameter),
                     "missing; set it to the path of a scene file, e.g. with roslaunch endovascular_sim sim.launch");
  std::istringstream words(node.param<std::string>(names::kOverridesParameter, ""));
  return scene::loadScene(file, {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()});
}

scene::Scene sceneWithLoggedWarnings(const ros::NodeHandle& node)
{
  scene::Scene scene = sceneFromParameters(node);
  for (const std::string& warning : scene.warnings)
    ROS_WARN("%s", warning.c_str());
  return scene;
}

}  // namespace endovascular_sim::nodes
