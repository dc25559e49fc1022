#pragma once

#include <cstddef>
#include <vector>

#include "contrast/cells/contrast_cells.h"
#include "flow/body/vessel_flow_tree.h"
#include "flow/coupling/flow_source.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::flow
{

/** Contrast cells of a flow network. They divide the halves of its cells, which are the control volumes of its nodes,
 *  into parts of at most 2.5 mm, or of 0.45 radii where these are longer. */
class ContrastGrid
{
public:
  ContrastGrid(const VesselFlowTree& vessel, const vessel::CentrelineTree& centreline);

  const contrast::ContrastCells& cells() const { return cells_; }
  std::size_t flowCell(std::size_t cell) const { return flow_cells_[cell]; }  ///< in which a contrast cell lies
  /** Node of the network whose half of that cell it is in. */
  std::size_t node(std::size_t cell) const { return nodes_[cell]; }
  /** Last contrast cell of a cell of the network, at its end. */
  std::size_t last(std::size_t flow_cell) const { return lasts_[flow_cell]; }

  /** Contrast cell that holds a place, the last one of its branch beyond that; −1 outside the vessel. Before the first
   *  cell of its branch, in the parent's lumen, it is the parent's cell. */
  int cellAt(const TreePlace& place) const;

private:
  void addHalf(const contrast::ContrastCell& half, std::size_t flow_cell, std::size_t node, double longest);

  contrast::ContrastCells cells_;
  std::vector<std::size_t> flow_cells_, nodes_;  // of each contrast cell
  std::vector<std::size_t> lasts_;               // of each cell of the network
  std::vector<CellRange> ranges_;                // contrast cells of each branch
  std::vector<int> parents_;                     // of each branch
};

/** The same as a function: cells of the network of vesselFlowTree(). */
inline contrast::ContrastCells contrastCells(const VesselFlowTree& vessel, const vessel::CentrelineTree& centreline)
{
  return ContrastGrid(vessel, centreline).cells();
}

}  // namespace endovascular_sim::flow
