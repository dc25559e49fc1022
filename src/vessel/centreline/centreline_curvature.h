#pragma once

#include <vector>

#include <Eigen/Core>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** How strongly a vessel bends at a place: the curvature of its centreline at the nearest point of it. */
class CentrelineCurvature
{
public:
  /** Curvature is that of the circle through three points of a branch, a lumen's radius apart: shorter bends are noise
   *  of the centreline. */
  explicit CentrelineCurvature(const CentrelineTree& tree);

  /** Curvature at the nearest point of the centreline; the lowest index among equally near ones; 0 without any [1/m].
   */
  double at(const Eigen::Vector3d& place) const;

private:
  void addBranch(const CentrelineBranch& branch);

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> curvature_;
};

}  // namespace endovascular_sim::vessel
