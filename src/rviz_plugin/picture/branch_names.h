#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "endovascular_sim/VesselCentreline.h"
#include "visualization/name_placement.h"

namespace endovascular_sim::rviz_plugin
{

/** Branches of a message with their displayed names, for visualization::placeNames(). Branches with a generated name
 *  (branch_<k>) have no text, and those with invalid points are not drawn.
 *  @param size_of size of a name in the picture [pixels]
 *  @param goal name of the branch that a person is to reach, which comes first; empty: none */
std::vector<visualization::BranchToName> branchesToName(
    const VesselCentreline& message, const std::function<Eigen::Vector2d(const std::string&)>& size_of,
    const std::string& goal = {});

/** Depth up to which branches have names: those around the tip, where the tip is in the picture; else infinite [m]. */
double reachOfNames(const Eigen::Vector3d& tip, const visualization::PictureView& view);

}  // namespace endovascular_sim::rviz_plugin
