#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "contrast/cells/contrast_cells.h"
#include "geometry/polyline.h"
#include "vessel/centreline/branch_finder.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::contrast
{

/** Assigns points to the cells of a vessel. */
class CellFinder
{
public:
  /** @param cells of the branches of @p centreline, each of which has two points at different places */
  CellFinder(const vessel::CentrelineTree& centreline, const ContrastCells& cells);

  /** Cell of the branch with the nearest lumen (vessel::BranchFinder), by arc length. Before the first cell of a branch
   *  it is that of the parent.
   *  @param point of the vessel at rest [m]
   *  @return −1 for a point that is not finite */
  int at(const Eigen::Vector3d& point) const;

private:
  vessel::BranchFinder branches_;
  std::vector<geometry::Polyline> lines_;
  std::vector<int> parents_;
  ContrastCells cells_;
  std::vector<std::vector<int>> cells_of_branch_;
};

}  // namespace endovascular_sim::contrast
