#pragma once

#include <cstddef>
#include <vector>

#include "contrast/cells/contrast_cells.h"

namespace endovascular_sim::contrast
{

/** Neighbours of the cells of a tree. The face of a cell is that to its parent. */
class CellTree
{
public:
  /** @throws std::invalid_argument for a parent that is no earlier cell, or a cell without length */
  explicit CellTree(const ContrastCells& cells);

  std::size_t size() const { return parents_.size(); }
  int parent(std::size_t cell) const { return parents_[cell]; }
  /** Cell that continues a cell away from the heart: that of the same branch, or else its only child; −1 without one.
   */
  int next(std::size_t cell) const { return next_[cell]; }
  /** Cell that is continued by a cell; −1 without one, e.g. at the beginning of a side branch. */
  int previous(std::size_t cell) const { return previous_[cell]; }
  double length(std::size_t cell) const { return lengths_[cell]; }  ///< [m]

  /** Children of a cell, ascending. @{ */
  const std::size_t* childrenBegin(std::size_t cell) const { return children_.data() + first_child_[cell]; }
  const std::size_t* childrenEnd(std::size_t cell) const { return children_.data() + first_child_[cell + 1]; }
  /** @} */

private:
  std::vector<int> parents_, next_, previous_;
  std::vector<double> lengths_;
  std::vector<std::size_t> first_child_, children_;
};

}  // namespace endovascular_sim::contrast
