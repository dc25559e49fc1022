#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "endovascular_sim/VesselCentreline.h"

namespace endovascular_sim::rviz_plugin
{

/** Projection of the scene into the picture. The axes are unit vectors, in the frame of the centreline. */
struct PictureView
{
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d right = Eigen::Vector3d::UnitX(), up = Eigen::Vector3d::UnitZ(), forward = Eigen::Vector3d::UnitY();
  double focal = 800.0;                            ///< distance of the picture from the eye [pixels]
  double width = 1000.0, height = 700.0;           ///< [pixels]
  double legend_width = 0.0, legend_height = 0.0;  ///< of the legends in the lower left corner [pixels]

  double depth(const Eigen::Vector3d& point) const { return forward.dot(point - eye); }
  /** Place relative to the middle of the picture, to the right and up [pixels].
   *  @param point before the eye: its depth is positive */
  Eigen::Vector2d project(const Eigen::Vector3d& point) const
  {
    return focal / depth(point) * Eigen::Vector2d(right.dot(point - eye), up.dot(point - eye));
  }
};

/** Name of a branch and its place. */
struct BranchName
{
  std::string text;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< left end of the text, at half its height [m]
  double height = 0.0;                                 ///< of the letters [m]
};

/** Names of the branches, each beside its branch in the picture. No two names overlap.
 *
 *  Branches with a generated name (branch_<k>), and those with invalid points, have none. The longest branches in the
 *  picture come first. A name takes the place, along the branch and on both of its sides, that covers the least of the
 *  vessel; it is missing where all places are covered by other names or the legends or lie outside of the picture, and
 * beside a branch that is shorter in the picture than two letters.
 *  @param letters height of the letters [pixels] */
std::vector<BranchName> branchNames(const VesselCentreline& message, const PictureView& view, double letters);

}  // namespace endovascular_sim::rviz_plugin
