#pragma once

#include <string>

#include <Eigen/Core>

#include "scene/model/scene.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::nodes
{

/** Text about the end of a vessel that is nearest to a point clicked in rviz: its branch, its distance, and the options
 * that name it, ready to be copied. Options for the mesh are in the frame of its file, in metres.
 *  @param point patient frame [m] */
std::string clickedEndText(const vessel::CentrelineTree& tree, const scene::VesselScene& scene,
                           const Eigen::Vector3d& point);

}  // namespace endovascular_sim::nodes
