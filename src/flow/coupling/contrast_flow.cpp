#include "flow/coupling/contrast_flow.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "contrast/medium/mixed_viscosity.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kLeastVolume = 0.02;  // of a cell, relative to that of the network

bool isPositive(double value)
{
  return std::isfinite(value) && value > 0.0;
}

void require(bool holds, const char* text)
{
  if (!holds)
    throw std::invalid_argument(text);
}

/** Volumes, with a least one for cells that hold nearly nothing of the lumen. */
std::vector<double> raised(std::vector<double> volumes, const ContrastGrid& grid, const FlowTree& tree)
{
  require(volumes.size() == grid.cells().size(), "flow: a volume is needed for each contrast cell");
  for (std::size_t k = 0; k < volumes.size(); ++k)
  {
    require(std::isfinite(volumes[k]) && volumes[k] >= 0.0, "flow: the volume of a contrast cell must not be negative");
    const double length = grid.cells()[k].end - grid.cells()[k].begin;
    volumes[k] = std::max(volumes[k], kLeastVolume * length * tree.cells[grid.flowCell(k)].wall.area);
  }
  return volumes;
}

}  // namespace

ContrastFlow::ContrastFlow(const VesselFlowTree& vessel, const vessel::CentrelineTree& centreline,
                           std::vector<double> volumes)
  : grid_(vessel, centreline),
    at_rest_(raised(std::move(volumes), grid_, vessel.tree)),
    transport_(grid_.cells(), at_rest_)
{
  for (const Windkessel& outlet : vessel.tree.outlets)
  {
    const auto cell = std::find_if(vessel.tree.cells.begin(), vessel.tree.cells.end(),
                                   [&outlet](const FlowCell& other) { return other.to == outlet.node; });
    const auto index = static_cast<std::size_t>(cell - vessel.tree.cells.begin());
    before_outlet_.push_back(cell == vessel.tree.cells.end() ? -1 : static_cast<int>(grid_.last(index)));
  }
  step_.before.resize(at_rest_.size());
  step_.after.resize(at_rest_.size());
  iodine_.assign(vessel.places.size(), 0.0);
  content_.assign(vessel.places.size(), 0.0);
}

void ContrastFlow::beforeStep(const FlowInjection& injection, FlowNetwork& network)
{
  release(network);
  if (transport_.isEmpty() && injection.volume == 0.0)
    return;
  is_acting_ = true;
  setSources(injection, network);
  findVolumes(network, step_.before);
  setViscosities(network);
}

void ContrastFlow::setSources(const FlowInjection& injection, FlowNetwork& network)
{
  if (injection.volume == 0.0)
    return;
  require(isPositive(injection.volume) && isPositive(injection.concentration) && isPositive(injection.viscosity),
          "flow: volume, concentration and viscosity of an injection must be positive");
  double sum = 0.0;
  for (const FlowOpening& opening : injection.openings)
  {
    require(isPositive(opening.share) && grid_.cellAt(opening.place) >= 0,
            "flow: an opening of an injection needs a positive share and a place in the vessel");
    sum += opening.share;
  }
  require(sum > 0.0, "flow: an injection needs an opening in the vessel");
  concentration_ = injection.concentration;
  viscosity_ = injection.viscosity;
  for (const FlowOpening& opening : injection.openings)
    step_.sources.push_back({static_cast<std::size_t>(grid_.cellAt(opening.place)),
                             injection.volume * opening.share / sum, injection.concentration});
  for (const contrast::CellSource& source : step_.sources)
  {
    const std::size_t node = grid_.node(source.cell);
    double volume = 0.0;
    for (const contrast::CellSource& other : step_.sources)
      volume += grid_.node(other.cell) == node ? other.volume : 0.0;
    network.setSource(node, volume / network.settings().time_step);
  }
}

/** Viscosity of each cell of the network with iodine, by the mean concentration in it. */
void ContrastFlow::setViscosities(FlowNetwork& network)
{
  for (std::size_t k = 0; k < at_rest_.size(); ++k)
    if (transport_.mass(k) > 0.0)
    {
      const std::size_t cell = grid_.flowCell(k);
      if (iodine_[cell] == 0.0)
        thickened_.push_back(cell);
      iodine_[cell] += transport_.mass(k);
    }
  if (thickened_.empty())
    return;
  for (std::size_t k = 0; k < at_rest_.size(); ++k)
    content_[grid_.flowCell(k)] += iodine_[grid_.flowCell(k)] > 0.0 ? step_.before[k] : 0.0;
  for (const std::size_t cell : thickened_)
  {
    const double share = iodine_[cell] / (content_[cell] * concentration_);
    network.setViscosityFactor(cell, contrast::mixedViscosityRatio(share, viscosity_, network.settings().viscosity));
    iodine_[cell] = content_[cell] = 0.0;
  }
}

/** Volumes of the cells at the present pressures [m³]. */
void ContrastFlow::findVolumes(const FlowNetwork& network, std::vector<double>& volumes) const
{
  double ratio = 1.0;
  for (std::size_t k = 0; k < at_rest_.size(); ++k)
  {
    const std::size_t cell = grid_.flowCell(k), node = grid_.node(k);
    if (k == 0 || cell != grid_.flowCell(k - 1) || node != grid_.node(k - 1))
    {
      const TubeLaw& wall = network.tree().cells[cell].wall;
      ratio = wall.areaAt(network.pressure(node) - network.settings().reference_pressure) / wall.area;
    }
    volumes[k] = at_rest_[k] * ratio;
  }
}

void ContrastFlow::afterStep(const FlowNetwork& network)
{
  if (!is_acting_)
    return;
  findVolumes(network, step_.after);
  step_.outflows.assign(at_rest_.size(), 0.0);
  for (std::size_t outlet = 0; outlet < before_outlet_.size(); ++outlet)
    if (before_outlet_[outlet] >= 0)
      step_.outflows[static_cast<std::size_t>(before_outlet_[outlet])] +=
          network.settings().time_step * network.outflow(outlet);
  transport_.step(step_);
}

/** Ends what contrast medium does to the network. */
void ContrastFlow::release(FlowNetwork& network)
{
  if (!is_acting_)
    return;
  is_acting_ = false;
  step_.sources.clear();
  network.clearSources();
  for (const std::size_t cell : thickened_)
    network.setViscosityFactor(cell, 1.0);
  thickened_.clear();
}

void ContrastFlow::clear(FlowNetwork& network)
{
  release(network);
  transport_.clear();
  concentration_ = viscosity_ = 0.0;
}

void ContrastFlow::fill(FlowField& field) const
{
  field.totals = {transport_.injected(), transport_.inside(), transport_.left()};
  field.iodine.clear();
  if (transport_.isEmpty())
    return;
  for (std::size_t k = 0; k < at_rest_.size(); ++k)
    field.iodine.push_back(transport_.concentration(k, step_.after[k]));
}

void ContrastFlow::archive(Archive& archive, FlowNetwork& network)
{
  double injected = network.injected();
  archive(injected, concentration_, viscosity_);
  transport_.archive(archive);
  if (!archive.reading())
    return;
  requireFinite(injected, concentration_, viscosity_);
  requireLoaded(concentration_ > 0.0 && viscosity_ > 0.0, "holds contrast medium without iodine or viscosity");
  network.setInjected(injected);
}

}  // namespace endovascular_sim::flow
