#pragma once

#include <vector>

#include "flow/body/vessel_flow_tree.h"
#include "flow/coupling/flow_source.h"

namespace endovascular_sim::flow
{

/** Cells of a vessel by their places, to read a FlowField. */
class FlowPlaces
{
public:
  /** @param branches number of branches of the centreline */
  FlowPlaces(const VesselFlowTree& tree, std::size_t branches);

  /** Index of the cell that holds a place, or of the nearest one on its branch; −1 for a branch without cells. */
  int cellAt(const TreePlace& place) const;

  /** Mean velocity of the blood at a place, positive away from the heart [m/s]. */
  double velocityAt(const FlowField& field, const TreePlace& place) const;

  /** Flow at a place [m³/s]. */
  double flowAt(const FlowField& field, const TreePlace& place) const;

  /** Pressure at a place, linear within a cell [Pa]. */
  double pressureAt(const FlowField& field, const TreePlace& place) const;

  const VesselFlowTree& tree() const { return tree_; }

private:
  VesselFlowTree tree_;
  std::vector<std::vector<int>> cells_;  ///< of each branch, ascending
};

}  // namespace endovascular_sim::flow
