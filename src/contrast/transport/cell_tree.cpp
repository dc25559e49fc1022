#include "contrast/transport/cell_tree.h"

#include <stdexcept>
#include <string>

namespace endovascular_sim::contrast
{

CellTree::CellTree(const ContrastCells& cells) : first_child_(cells.size() + 1, 0)
{
  for (std::size_t k = 0; k < cells.size(); ++k)
  {
    const ContrastCell& cell = cells[k];
    if (cell.parent < -1 || cell.parent >= static_cast<int>(k) || !(cell.end > cell.begin))
      throw std::invalid_argument("contrast cell " + std::to_string(k) +
                                  " must have a length, and a parent of a smaller index or none");
    parents_.push_back(cell.parent);
    lengths_.push_back(cell.end - cell.begin);
    if (cell.parent >= 0)
      ++first_child_[static_cast<std::size_t>(cell.parent) + 1];
  }
  for (std::size_t k = 0; k < cells.size(); ++k)
    first_child_[k + 1] += first_child_[k];
  children_.resize(first_child_.back());
  std::vector<std::size_t> end(first_child_.begin(), first_child_.end() - 1);
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (parents_[k] >= 0)
      children_[end[static_cast<std::size_t>(parents_[k])]++] = k;
  next_.assign(cells.size(), -1);
  previous_.assign(cells.size(), -1);
  for (std::size_t k = 0; k < cells.size(); ++k)
  {
    const bool has_one = childrenEnd(k) - childrenBegin(k) == 1;
    for (const std::size_t* child = childrenBegin(k); child != childrenEnd(k); ++child)
      if (next_[k] < 0 && (has_one || cells[*child].branch == cells[k].branch))
      {
        next_[k] = static_cast<int>(*child);
        previous_[*child] = static_cast<int>(k);
      }
  }
}

}  // namespace endovascular_sim::contrast
