#include "contrast/cells/cell_finder.h"

#include <algorithm>

namespace endovascular_sim::contrast
{

CellFinder::CellFinder(const vessel::CentrelineTree& centreline, const ContrastCells& cells)
  : branches_(centreline), cells_(cells), cells_of_branch_(centreline.branches.size())
{
  for (const vessel::CentrelineBranch& branch : centreline.branches)
  {
    lines_.emplace_back(branch.points);
    parents_.push_back(branch.parent);
  }
  for (std::size_t k = 0; k < cells.size(); ++k)
    cells_of_branch_[static_cast<std::size_t>(cells[k].branch)].push_back(static_cast<int>(k));
}

int CellFinder::at(const Eigen::Vector3d& point) const
{
  for (int branch = branches_.nearest(point); branch >= 0; branch = parents_[static_cast<std::size_t>(branch)])
  {
    const std::vector<int>& own = cells_of_branch_[static_cast<std::size_t>(branch)];
    if (own.empty())
      continue;
    const double arc = lines_[static_cast<std::size_t>(branch)].nearest(point).arc;
    const auto cell = [this](int k) { return cells_[static_cast<std::size_t>(k)]; };
    if (arc < cell(own.front()).begin && parents_[static_cast<std::size_t>(branch)] >= 0)
      continue;
    const auto after =
        std::upper_bound(own.begin() + 1, own.end(), arc, [&](double a, int k) { return a < cell(k).begin; });
    return *(after - 1);
  }
  return -1;
}

}  // namespace endovascular_sim::contrast
