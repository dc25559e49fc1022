#pragma once

#include <vector>

#include <Eigen/Core>

#include "flow/coupling/flow_source.h"
#include "vessel/centreline/branch_finder.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::flow
{

/** Part of a path in the tree: a stretch of one branch, passed from `from` to `to`. */
struct Stretch
{
  int branch = 0;
  double from = 0.0;  ///< arc lengths on the branch [m]
  double to = 0.0;

  double length() const;
};

/** Path in the tree of a centreline, from one place to another one. */
class TreePath
{
public:
  explicit TreePath(std::vector<Stretch> stretches) : stretches_(std::move(stretches)) {}

  double length() const;  ///< [m]

  /** Place at a distance from the beginning [m], clamped to the ends; branch −1 for a path without stretches. */
  TreePlace at(double distance) const;

  /** Adds the spans of an instrument that lies on the path between two distances from the beginning [m].
   *  @param radius of the instrument [m] */
  void addSpans(double begin, double end, double radius, std::vector<InstrumentSpan>& spans) const;

private:
  std::vector<Stretch> stretches_;
};

/** Places and paths in the tree of a centreline. Of its points those are used that lie 2 mm or more apart, which is
 * exact enough for the flow: places are asked for at every step of it. */
class TreePaths
{
public:
  explicit TreePaths(const vessel::CentrelineTree& tree);

  /** Place whose lumen is nearest to a point [m]; the branch is −1 without a centreline. */
  TreePlace locate(const Eigen::Vector3d& point) const;

  /** The same for a point near another one: where it lies well within the lumen of that one's branch, no other branch
   *  is looked at. @param near place of the other point */
  TreePlace locate(const Eigen::Vector3d& point, const TreePlace& near) const;

  /** Path between two places over their common ancestor; empty where one of them is outside. */
  TreePath between(const TreePlace& from, const TreePlace& to) const;

  /** Unit tangent of a branch, away from the heart. */
  Eigen::Vector3d tangentAt(const TreePlace& place) const;

private:
  /** Branch with few points, and their arc lengths on the centreline. */
  struct Line
  {
    std::vector<Eigen::Vector3d> points;  ///< [m]
    std::vector<double> arcs;             ///< [m]
    std::vector<double> radii;            ///< [m]

    double nearest(const Eigen::Vector3d& point) const;
    std::size_t segmentAt(double arc) const;
  };

  /** Points of a centreline, some of them. */
  struct Thinned
  {
    std::vector<Line> lines;
    vessel::CentrelineTree tree;
  };

  explicit TreePaths(Thinned thinned);
  static Thinned thinned(const vessel::CentrelineTree& tree);
  std::vector<TreePlace> toRoot(const TreePlace& place) const;

  std::vector<Line> lines_;
  std::vector<int> parents_;
  std::vector<double> on_parent_;  ///< of each branch: arc length on its parent at which it begins [m]
  vessel::BranchFinder finder_;
};

}  // namespace endovascular_sim::flow
