#pragma once

#include <string>

#include <ros/node_handle.h>

#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Scene of the parameters `scene` and `overrides` in the node handle's namespace; without them that of a recording,
 * whose text is the parameter `scene_text`.
 *  @throws InputError when the parameter is missing or the scene is invalid */
scene::Scene sceneFromParameters(const ros::NodeHandle& node);

/** Pseudonym of the trainee in the scene of these parameters, key `record.subject`; empty without one. */
std::string subjectFromParameters(const ros::NodeHandle& node);

/** The same scene, with its unusual values logged as warnings. Only rod_dynamics logs them, since it is part of every
 *  graph. */
scene::Scene sceneWithLoggedWarnings(const ros::NodeHandle& node);

}  // namespace endovascular_sim::nodes
