#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::segmentation
{

/** Centreline with the branches of labels, from one that ends at every fork. A branch is cut where the label changes
 * for more than three radii, and continued beyond a fork by the straightest and widest branch of the same label.
 * Further branches of a label are numbered: "aorta", "aorta_2".
 *  @param labelAt index of the label at a point; −1 where it is unknown
 *  @param names name of every label */
vessel::CentrelineTree namedByLabels(const vessel::CentrelineTree& tree,
                                     const std::function<int(const Eigen::Vector3d&)>& labelAt,
                                     const std::vector<std::string>& names);

}  // namespace endovascular_sim::segmentation
