#include "flow/coupling/contrast_grid.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kLongest = 2.5e-3;       // [m]
constexpr double kLongestInRadii = 0.45;  // where that is longer
constexpr double kLengthRounding = 1e-9;  // relative

std::size_t indexOf(int value)
{
  return static_cast<std::size_t>(value);
}

}  // namespace

ContrastGrid::ContrastGrid(const VesselFlowTree& vessel, const vessel::CentrelineTree& centreline)
  : ranges_(centreline.branches.size())
{
  for (const vessel::CentrelineBranch& branch : centreline.branches)
    parents_.push_back(branch.parent);
  std::vector<int> at_node(indexOf(vessel.tree.nodes), -1);  // contrast cell that ends there
  for (std::size_t k = 0; k < vessel.places.size(); ++k)
  {
    const FlowCell& cell = vessel.tree.cells[k];
    const CellPlace& place = vessel.places[k];
    const double middle = 0.5 * (place.begin + place.end);
    const double longest = std::max(kLongest, kLongestInRadii * std::sqrt(cell.wall.area / kPi));
    CellRange& range = ranges_[indexOf(place.branch)];
    if (range.begin == range.end)
      range.begin = cells_.size();
    const int parent = at_node[indexOf(cell.from)];
    addHalf({place.branch, place.begin, middle, parent}, k, indexOf(cell.from), longest);
    addHalf({place.branch, middle, place.end, static_cast<int>(cells_.size()) - 1}, k, indexOf(cell.to), longest);
    range.end = cells_.size();
    lasts_.push_back(cells_.size() - 1);
    at_node[indexOf(cell.to)] = static_cast<int>(cells_.size()) - 1;
  }
}

/** Divides half of a cell of the network. */
void ContrastGrid::addHalf(const contrast::ContrastCell& half, std::size_t flow_cell, std::size_t node, double longest)
{
  const double length = half.end - half.begin;
  const int count = std::max(1, static_cast<int>(std::ceil(length / longest * (1.0 - kLengthRounding))));
  contrast::ContrastCell cell = half;
  if (!cells_.empty() && cells_.back().branch == half.branch)
    cell.begin = cells_.back().end;  // the same place, but for rounding
  for (int k = 1; k <= count; ++k)
  {
    cell.end = k == count ? half.end : half.begin + length * k / count;
    cells_.push_back(cell);
    flow_cells_.push_back(flow_cell);
    nodes_.push_back(node);
    cell.begin = cell.end;
    cell.parent = static_cast<int>(cells_.size()) - 1;
  }
}

int ContrastGrid::cellAt(const TreePlace& place) const
{
  int branch = place.branch;
  if (branch < 0 || indexOf(branch) >= ranges_.size())
    return -1;
  const auto isEmpty = [this](int b) { return ranges_[indexOf(b)].begin == ranges_[indexOf(b)].end; };
  if (isEmpty(branch))
  {
    while (branch >= 0 && isEmpty(branch))
      branch = parents_[indexOf(branch)];
    return branch < 0 ? -1 : static_cast<int>(ranges_[indexOf(branch)].end) - 1;
  }
  const CellRange& range = ranges_[indexOf(branch)];
  const auto first = cells_.begin() + static_cast<std::ptrdiff_t>(range.begin);
  const auto last = cells_.begin() + static_cast<std::ptrdiff_t>(range.end);
  if (place.arc < first->begin && first->parent >= 0)
    return first->parent;
  const auto found = std::partition_point(
      first, last - 1, [&place](const contrast::ContrastCell& cell) { return cell.end < place.arc; });
  return static_cast<int>(found - cells_.begin());
}

}  // namespace endovascular_sim::flow
