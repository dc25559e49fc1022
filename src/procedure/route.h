#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/polyline.h"
#include "procedure/branch_locator.h"

namespace endovascular_sim::procedure
{

/** Path along the centrelines from the introducer to the end of a goal branch, with its junctions. */
class Route
{
public:
  /** @param locator branches of the vessel
   *  @param from branch that contains the introducer
   *  @param entry position of the introducer, patient frame [m]
   *  @param to goal branch, other than @p from */
  Route(const BranchLocator& locator, int from, const Eigen::Vector3d& entry, int to);

  const geometry::Polyline& line() const { return line_; }  ///< centreline of the path [m]

  /** Arc lengths at which the path leaves a branch by its side, or passes the mouth of a branch [m]. */
  const std::vector<double>& junctions() const { return junctions_; }

  /** Distance along the path from a point's foot to the nearest junction [m]: positive ahead of the foot, negative
   *  behind it. Infinite without a junction. */
  double toJunction(double arc) const;

private:
  geometry::Polyline line_;
  std::vector<double> junctions_;
};

}  // namespace endovascular_sim::procedure
