#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::vessel
{

/** Unbranched segment of the centreline tree, from its proximal (heart-side or parent-side) to its distal end. */
struct CentrelineBranch
{
  std::string name;                     ///< anatomical name, or "branch_<k>" if unknown
  int parent = -1;                      ///< index of the parent branch, −1 at the root
  std::vector<Eigen::Vector3d> points;  ///< points [m]; the first lies on the parent branch
  std::vector<double> radii;            ///< radius of the maximal inscribed sphere at each point [m]
};

/** Centreline tree of a vessel. Leaf tips and the root's first point are the ends of the vessel. */
struct CentrelineTree
{
  std::vector<CentrelineBranch> branches;
};

/** End of the centreline, a possible point of entry. */
struct CentrelineEnd
{
  int branch = 0;            ///< index into CentrelineTree::branches
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d inward;    ///< unit vector from the end into the vessel
  double radius = 0.0;       ///< radius of the lumen [m]
};

/** Ends of the tree (leaf tips, and the root's first point), in branch order. */
std::vector<CentrelineEnd> centrelineEnds(const CentrelineTree& tree);

}  // namespace endovascular_sim::vessel
