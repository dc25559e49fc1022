#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::vessel
{

/** One unbranched piece of the centreline tree, from its proximal (heart-side or parent-side) to its distal end. */
struct CentrelineBranch
{
  std::string name;                     ///< anatomical name, or "branch_<k>" where the mesh does not tell
  int parent = -1;                      ///< index of the parent branch, −1 at the root
  std::vector<Eigen::Vector3d> points;  ///< [m], the first one lies on the parent branch
  std::vector<double> radii;            ///< [m], radius of the largest inscribed sphere at each point
};

/** The centreline tree of a vessel. Leaves (and the root's first point) are the vessel's ends. */
struct CentrelineTree
{
  std::vector<CentrelineBranch> branches;
};

/** An end of the centreline: where a vessel can be entered. */
struct CentrelineEnd
{
  int branch = 0;            ///< index into CentrelineTree::branches
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d inward;    ///< unit vector from the end into the vessel
  double radius = 0.0;       ///< [m]
};

/** All ends of the tree (leaf tips, and the root's first point), in branch order. */
std::vector<CentrelineEnd> centrelineEnds(const CentrelineTree& tree);

}  // namespace endovascular_sim::vessel
