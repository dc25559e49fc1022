#include "nodes/runtime/scene_parameters.h"

#include <iterator>
#include <sstream>
#include <vector>

#include <ros/console.h>

#include "common/error.h"
#include "nodes/runtime/ros_names.h"
#include "scene/scene_file.h"

namespace endovascular_sim::nodes
{

namespace
{

std::vector<std::string> overridesFrom(const ros::NodeHandle& node)
{
  std::istringstream words(node.param<std::string>(names::kOverridesParameter, ""));
  return {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()};
}

}  // namespace

scene::Scene sceneFromParameters(const ros::NodeHandle& node)
{
  std::string file, text;
  if (!node.hasParam(names::kSceneParameter) && node.getParam(names::kSceneTextParameter, text) && !text.empty())
    return scene::parseRecordedScene(text, node.resolveName(names::kSceneTextParameter));
  if (!node.getParam(names::kSceneParameter, file))
    throw InputError("parameter server", node.resolveName(names::kSceneParameter),
                     "missing; set it to the path of a scene file, e.g. with roslaunch endovascular_sim sim.launch");
  return scene::loadScene(file, overridesFrom(node));
}

std::string subjectFromParameters(const ros::NodeHandle& node)
{
  return scene::recordSubject(node.param<std::string>(names::kSceneParameter, ""), overridesFrom(node));
}

scene::Scene sceneWithLoggedWarnings(const ros::NodeHandle& node)
{
  scene::Scene scene = sceneFromParameters(node);
  for (const std::string& warning : scene.warnings)
    ROS_WARN("%s", warning.c_str());
  return scene;
}

}  // namespace endovascular_sim::nodes
