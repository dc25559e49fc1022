#include "flow/coupling/flow_places.h"

#include <algorithm>

namespace endovascular_sim::flow
{

FlowPlaces::FlowPlaces(const VesselFlowTree& tree, std::size_t branches) : tree_(tree), cells_(branches)
{
  for (std::size_t k = 0; k < tree_.places.size(); ++k)
    cells_.at(static_cast<std::size_t>(tree_.places[k].branch)).push_back(static_cast<int>(k));
  for (std::vector<int>& cells : cells_)
    std::sort(
        cells.begin(), cells.end(),
        [this](int a, int b)
        { return tree_.places[static_cast<std::size_t>(a)].begin < tree_.places[static_cast<std::size_t>(b)].begin; });
}

int FlowPlaces::cellAt(const TreePlace& place) const
{
  if (place.branch < 0 || cells_[static_cast<std::size_t>(place.branch)].empty())
    return -1;
  const std::vector<int>& cells = cells_[static_cast<std::size_t>(place.branch)];
  const auto after = std::upper_bound(cells.begin(), cells.end(), place.arc,
                                      [this](double arc, int cell)
                                      { return arc < tree_.places[static_cast<std::size_t>(cell)].begin; });
  return after == cells.begin() ? cells.front() : *(after - 1);
}

double FlowPlaces::velocityAt(const FlowField& field, const TreePlace& place) const
{
  const int cell = cellAt(place);
  return cell < 0 ? 0.0 : field.flows[static_cast<std::size_t>(cell)] / field.areas[static_cast<std::size_t>(cell)];
}

double FlowPlaces::flowAt(const FlowField& field, const TreePlace& place) const
{
  const int cell = cellAt(place);
  return cell < 0 ? 0.0 : field.flows[static_cast<std::size_t>(cell)];
}

double FlowPlaces::pressureAt(const FlowField& field, const TreePlace& place) const
{
  const int found = cellAt(place);
  if (found < 0)
    return 0.0;
  const auto cell = static_cast<std::size_t>(found);
  const CellPlace& at = tree_.places[cell];
  const double share = std::clamp((place.arc - at.begin) / (at.end - at.begin), 0.0, 1.0);
  const double from = field.pressures[static_cast<std::size_t>(tree_.tree.cells[cell].from)];
  const double to = field.pressures[static_cast<std::size_t>(tree_.tree.cells[cell].to)];
  return from + share * (to - from);
}

}  // namespace endovascular_sim::flow
