#pragma once

#include <vector>

#include <Eigen/Core>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Curvature of a vessel's centreline, queried by position. */
class CentrelineCurvature
{
public:
  /** Evaluates the Menger curvature of three points of a branch, spaced by the lumen's radius. Bends on a shorter scale
   *  are noise of the centreline. */
  explicit CentrelineCurvature(const CentrelineTree& tree);

  /** Curvature at the nearest point of the centreline [1/m]; 0 for an empty centreline. Among equally near points, the
   *  first one counts. */
  double at(const Eigen::Vector3d& point) const;

private:
  void addBranch(const CentrelineBranch& branch);

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> curvature_;
};

}  // namespace endovascular_sim::vessel
