#pragma once

#include <vector>

namespace endovascular_sim::contrast
{

/** Stretch of a branch between two planes normal to its centreline. */
struct ContrastCell
{
  int branch = 0;      ///< index of the branch
  double begin = 0.0;  ///< arc lengths of its ends on the branch [m]
  double end = 0.0;
  int parent = -1;  ///< cell nearer to the heart, with a smaller index; −1 at the inlet
};

/** Cells of a vessel: those of a branch by ascending arc length, parents before their children. */
using ContrastCells = std::vector<ContrastCell>;

}  // namespace endovascular_sim::contrast
