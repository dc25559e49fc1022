#pragma once

#include <cstddef>
#include <vector>

#include "contrast/transport/transport.h"
#include "flow/coupling/contrast_grid.h"
#include "flow/coupling/flow_source.h"
#include "flow/network/flow_network.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::flow
{

/** Contrast medium in the flow of blood.
 *
 *  It pushes the flow with its volume and thickens the blood. The volume of a cell is that of the lumen at rest times
 *  the present area of the network's wall there, relative to that of the reference pressure. The transport's flows
 *  follow from these volumes, so that they differ from those of the network by the volumes that both store differently:
 *  not in the mean of a beat. Instruments do not reduce the volume of a cell. */
class ContrastFlow
{
public:
  /** @param vessel with the outlets of the network
   *  @param volumes of the contrast cells at rest [m³]; one below a fiftieth of that of the healthy network, e.g. of a
   *         cell in which a mesh has no triangles, is raised to it
   *  @throws std::invalid_argument for another number of volumes than of cells, or one that is negative */
  ContrastFlow(const VesselFlowTree& vessel, const vessel::CentrelineTree& centreline, std::vector<double> volumes);

  /** Sets sources and viscosities of the network for its next step.
   *  @throws std::invalid_argument for an injection that is not possible, or without an opening in the vessel */
  void beforeStep(const FlowInjection& injection, FlowNetwork& network);
  /** Moves the iodine by the step that the network has made. */
  void afterStep(const FlowNetwork& network);

  /** Removes all iodine, and what it does to the network. */
  void clear(FlowNetwork& network);
  /** True if iodine was ever injected. */
  bool isUsed() const { return transport_.injected() > 0.0; }

  void fill(FlowField& field) const;

  const ContrastGrid& grid() const { return grid_; }
  const contrast::Transport& transport() const { return transport_; }

  /** Iodine, and the volume that was injected into the network.
   *  @throws ArchiveError for an archive of another vessel */
  void archive(Archive& archive, FlowNetwork& network);

private:
  void setSources(const FlowInjection& injection, FlowNetwork& network);
  void setViscosities(FlowNetwork& network);
  void findVolumes(const FlowNetwork& network, std::vector<double>& volumes) const;
  void release(FlowNetwork& network);

  ContrastGrid grid_;
  std::vector<double> at_rest_;     // volume of each cell [m³]
  std::vector<int> before_outlet_;  // of each outlet of the network: the cell that ends there; −1 at the inlet
  contrast::Transport transport_;
  double concentration_ = 0.0, viscosity_ = 0.0;  // of the last medium [kg/m³], [Pa·s]
  contrast::BloodStep step_;
  std::vector<double> iodine_, content_;  // of each cell of the network: iodine [kg], volume [m³]
  std::vector<std::size_t> thickened_;    // cells of the network with contrast medium
  bool is_acting_ = false;                // on the network
};

}  // namespace endovascular_sim::flow
