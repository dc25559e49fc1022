#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/polyline.h"
#include "scene/model/scene_procedure.h"
#include "vessel/centreline/branch_finder.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::procedure
{

/** Position in the tree of branches. */
struct BranchPosition
{
  int branch = -1;     ///< branch of the centreline; −1: outside the vessel
  double depth = 0.0;  ///< distance from the ostium along the branch, positive in distal direction [m]
};

/** Localisation of points in the branches of a vessel, and paths through the tree of branches. */
class BranchLocator
{
public:
  /** @param tree centreline tree of the vessel
   *  @param names names of the procedure for branches, in addition to those of the vessel */
  explicit BranchLocator(const vessel::CentrelineTree& tree, const std::vector<scene::NamedBranch>& names = {});

  /** Branch position of a point in the patient frame [m]. */
  BranchPosition at(const Eigen::Vector3d& point) const;

  /** Distance from the ostium of a branch to the projection of a point onto the branch, along the branch [m]. */
  double depthIn(int branch, const Eigen::Vector3d& point) const;

  /** Index of the branch with a name; −1 if there is none. Names of the procedure take precedence. */
  int find(const std::string& name) const;

  /** Name of a branch, by the procedure if it gives one; "outside" for −1. */
  const std::string& name(int branch) const;

  /** Comma-separated names of all branches, for messages. */
  std::string names() const;

  /** Path between two branches: for each branch, whether it lies on the path, ends included. All do if an end is −1. */
  std::vector<bool> pathBetween(int from, int to) const;

  const geometry::Polyline& line(int branch) const { return lines_[static_cast<std::size_t>(branch)]; }

  /** Parent of a branch; −1 at the root. */
  int parent(int branch) const { return parent_[static_cast<std::size_t>(branch)]; }

  int branches() const { return static_cast<int>(names_.size()); }

private:
  std::vector<geometry::Polyline> lines_;
  std::vector<double> ostium_;  ///< arc length at which a branch leaves the lumen of its wider ancestors [m]
  std::vector<int> parent_;
  std::vector<std::string> names_;         ///< displayed names
  std::vector<std::string> vessel_names_;  ///< names in the vessel
  vessel::BranchFinder finder_;
};

}  // namespace endovascular_sim::procedure
