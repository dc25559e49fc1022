#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flow/body/circulation.h"
#include "flow/network/flow_network.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::flow
{

/** Cells of the flow network along a vessel. */
struct CellLengths
{
  double usual = 8e-3;       ///< [m]
  double in_lesions = 2e-3;  ///< in branches with lesions [m]
};

/** Place of a cell on the centreline. */
struct CellPlace
{
  int branch = 0;      ///< index of the branch
  double begin = 0.0;  ///< arc lengths of its ends on the branch [m]
  double end = 0.0;
};

/** Cells of a branch: consecutive ones, by increasing arc length. */
struct CellRange
{
  std::size_t begin = 0;
  std::size_t end = 0;  ///< behind the last one
};

/** End of the vessel through which blood leaves. */
struct OutletPlace
{
  int branch = 0;       ///< index of the branch that ends there
  int node = 0;         ///< of the network
  double radius = 0.0;  ///< at the end [m]
  int territory = -1;   ///< index in the circulation; −1 without a named ancestor
};

/** Flow network of a vessel, without the values of its outlets. */
struct VesselFlowTree
{
  FlowTree tree;
  std::vector<CellPlace> places;     ///< of each cell
  std::vector<CellRange> ranges;     ///< of each branch
  std::vector<OutletPlace> outlets;  ///< ends of the branches
  double inlet_radius = 0.0;         ///< at the root's first point [m]
};

/** Centreline with the radii of the healthy vessel: those of a lesion are interpolated between its ends. The network
 * has healthy walls; lesions are obstacles in it, which balloons and stents reduce. */
vessel::CentrelineTree withoutLesions(vessel::CentrelineTree centreline,
                                      const std::vector<vessel::PlacedLesion>& lesions);

/** Divides a centreline into cells. A branch begins where its centreline leaves the lumen of its parent. Branches that
 *  leave their parent within the shortest cell of each other share a node.
 *  @param fine for each branch: true selects CellLengths::in_lesions
 *  @throws InputError for a centreline without branches, or with a branch without a place in the tree (a loop, a second
 *          root), length or lumen */
VesselFlowTree vesselFlowTree(const vessel::CentrelineTree& centreline, const Circulation& circulation,
                              const CellLengths& lengths, const std::vector<bool>& fine);

}  // namespace endovascular_sim::flow
