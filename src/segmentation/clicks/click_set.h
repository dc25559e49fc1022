#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::segmentation
{

/** Click of an operator into the lumen. */
struct Click
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< patient frame [m]
  std::string where;                                   ///< place in its file, e.g. "line 7"
};

/** Clicks along one branch, from one end to the other, or at the ends of a tree, the first one at its beginning. */
struct BranchClicks
{
  std::string name;
  std::vector<Click> clicks;    ///< two or more
  double largest_radius = 0.0;  ///< bound of the lumen's radius [m]; 0: from the lumen at the clicks
  bool are_ends = false;        ///< true for the ends of a tree (tree_of_ends.h)
};

/** Clicks of one vessel tree. */
struct ClickSet
{
  std::string file;
  std::vector<BranchClicks> branches;
};

/** Reads clicks: YAML of this package (.yaml), or markups of 3D Slicer (.mrk.json, .fcsv).
 *
 *  YAML: `frame` LPS or RAS [LPS], `unit` metres per unit [0.001], `branches`: a list of `name`, `clicks` (list of
 * points) or `ends` (likewise, at the ends of a tree), and optionally `largest_radius`. In markups, the control points
 * whose labels differ only in a number at the end form a branch ("LAD-1", "LAD-2"). Where a file holds one branch with
 * a default label ("F-1"), the branch has the name of the file. Points of a list "Endpoints", as SlicerVMTK makes it,
 * are the ends of a tree; one that is not selected is its beginning. The coordinate system is that of the file. Names
 * keep the letters of all scripts.
 *  @throws InputError naming file, line or point, and remedy */
ClickSet readClicks(const std::string& file);

/** Unites the clicks of several files.
 *  @throws InputError for no file, and two branches of one name */
ClickSet readClicks(const std::vector<std::string>& files);

/** @throws InputError for two branches of one name */
void requireDifferentNames(const ClickSet& clicks);

}  // namespace endovascular_sim::segmentation
