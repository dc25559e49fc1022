#include "flow/network/flow_network.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/archive.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr int kPasses = 2;             // of Newton's method, which suffice as a rule
constexpr int kMostPasses = 30;        // in vessels that collapse
constexpr double kVolumeError = 1e-7;  // relative, at which further passes are needed
constexpr double kClosed = 1e-3;       // share of the area that remains free in a closed cell
constexpr double kVacuum = 0.02;       // share of the volume at the reference pressure that a vessel keeps
constexpr int kMostScalarPasses = 60;
constexpr double kCourant = 0.8;  // largest Courant number of the explicit convection, which limits its velocity

std::size_t indexOf(int value)
{
  return static_cast<std::size_t>(value);
}

}  // namespace

FlowNetwork::FlowNetwork(FlowTree tree, const FlowSettings& settings, double pressure)
  : tree_(std::move(tree)), settings_(settings)
{
  check();
  link();
  const std::size_t nodes = indexOf(tree_.nodes), cells = tree_.cells.size(), outlets = tree_.outlets.size();
  obstacles_.resize(cells);
  factors_.assign(outlets, 1.0);
  viscosity_.assign(cells, 1.0);
  windkessels_.assign(outlets, WindkesselState(pressure));
  pressures_.assign(nodes, pressure);
  volumes_.resize(nodes);
  for (std::size_t node = 0; node < nodes; ++node)
    volumes_[node] = volumeAt(node, pressure - settings_.reference_pressure);
  smallest_volumes_.resize(nodes);
  smallest_pressures_.resize(nodes);
  for (std::size_t node = 0; node < nodes; ++node)
  {
    smallest_volumes_[node] = kVacuum * volumeAt(node, 0.0);
    smallest_pressures_[node] = pressureOf(node, smallest_volumes_[node]);
  }
  flows_.assign(cells, 0.0);
  old_flows_.assign(cells, 0.0);
  outflows_.assign(outlets, 0.0);
  explicit_flows_.resize(cells);
  conductances_.resize(cells);
  diagonal_.resize(nodes);
  right_side_.resize(nodes);
  fixed_volumes_.resize(nodes);
  constants_.assign(nodes, 0.0);
  compliances_.assign(nodes, 0.0);
  areas_.resize(cells);
}

void FlowNetwork::check() const
{
  const auto require = [](bool holds, const std::string& text)
  {
    if (!holds)
      throw std::invalid_argument("flow network: " + text);
  };
  require(settings_.time_step > 0.0 && settings_.density > 0.0 && settings_.viscosity >= 0.0,
          "time step and density must be positive, the viscosity not negative");
  require(settings_.implicitness >= 0.5 && settings_.implicitness <= 1.0, "the implicitness must be 0.5 to 1");
  std::vector<int> ends(indexOf(std::max(tree_.nodes, 1)), 0);
  for (const FlowCell& cell : tree_.cells)
  {
    require(cell.from >= 0 && cell.from < cell.to && cell.to < tree_.nodes,
            "a cell must lead to a node of a larger index");
    require(cell.length > 0.0 && cell.wall.area > 0.0 && cell.wall.stiffness > 0.0 && cell.inertia > 0.0,
            "length, area, stiffness and inertia of a cell must be positive");
    ++ends[indexOf(cell.to)];
  }
  for (std::size_t node = 1; node < ends.size(); ++node)
    require(ends[node] == 1, "node " + std::to_string(node) + " must be the end of one cell, it is that of " +
                                 std::to_string(ends[node]));
  for (const Windkessel& outlet : tree_.outlets)
    require(outlet.node >= 0 && outlet.node < tree_.nodes && outlet.proximal > 0.0 && outlet.distal > 0.0 &&
                outlet.compliance >= 0.0,
            "an outlet needs a node, positive resistances, and a compliance that is not negative");
}

void FlowNetwork::link()
{
  const std::size_t nodes = indexOf(tree_.nodes), cells = tree_.cells.size();
  halves_.resize(nodes);
  cell_to_.resize(nodes);
  before_.assign(cells, -1);
  after_.assign(cells, -1);
  for (std::size_t k = 0; k < cells; ++k)
  {
    const FlowCell& cell = tree_.cells[k];
    for (const int node : {cell.from, cell.to})
      halves_[indexOf(node)].push_back({k, 0.5 * cell.length});
    cell_to_[indexOf(cell.to)] = k;
  }
  for (std::size_t node = 1; node < nodes; ++node)
  {
    if (halves_[node].size() != 2)
      continue;  // a junction or an end
    const std::size_t first = cell_to_[node];
    const std::size_t second = halves_[node][0].cell == first ? halves_[node][1].cell : halves_[node][0].cell;
    if (tree_.cells[first].segment != tree_.cells[second].segment)
      continue;
    after_[first] = static_cast<int>(second);
    before_[second] = static_cast<int>(first);
  }
}

void FlowNetwork::setResistanceFactor(std::size_t outlet, double factor)
{
  if (!(factor > 0.0))
    throw std::invalid_argument("flow network: the factor of a resistance must be positive");
  factors_[outlet] = factor;
}

void FlowNetwork::setSource(std::size_t node, double flow)
{
  if (node >= volumes_.size() || !std::isfinite(flow))
    throw std::invalid_argument("flow network: a source needs a node of the network and a finite flow");
  const auto source =
      std::find_if(sources_.begin(), sources_.end(), [node](const Source& other) { return other.node == node; });
  if (source != sources_.end())
    sources_.erase(source);
  if (flow != 0.0)
    sources_.push_back({node, flow});
}

void FlowNetwork::setViscosityFactor(std::size_t cell, double factor)
{
  if (!(std::isfinite(factor) && factor > 0.0))
    throw std::invalid_argument("flow network: the factor of a viscosity must be positive");
  viscosity_.at(cell) = factor;
}

double FlowNetwork::meanExcess(std::size_t cell) const
{
  return 0.5 * (excess(tree_.cells[cell].from) + excess(tree_.cells[cell].to));
}

double FlowNetwork::volumeAt(std::size_t node, double excess) const
{
  double volume = 0.0;
  for (const HalfCell& half : halves_[node])
    volume += half.length * tree_.cells[half.cell].wall.areaAt(excess);
  return volume;
}

double FlowNetwork::complianceAt(std::size_t node, double excess) const
{
  double compliance = 0.0;
  for (const HalfCell& half : halves_[node])
    compliance += half.length * tree_.cells[half.cell].wall.complianceAt(excess);
  return compliance;
}

/** αQ²/A at the node between two cells, upwind [m⁴/s²]. */
double FlowNetwork::momentumFlux(std::size_t left, std::size_t right) const
{
  const double flow = 0.5 * (flows_[left] + flows_[right]);
  const std::size_t upwind = flow > 0.0 ? left : right;
  const double fastest = kCourant * tree_.cells[upwind].length / settings_.time_step;
  return settings_.momentum_factor * flow * std::clamp(flows_[upwind] / areas_[upwind], -fastest, fastest);
}

/** ∂(αQ²/A)/∂x of a cell [m³/s²]; zero beside junctions and ends, where the one-dimensional equation does not hold. */
double FlowNetwork::convection(std::size_t cell) const
{
  if (before_[cell] < 0 || after_[cell] < 0)
    return 0.0;
  return (momentumFlux(cell, indexOf(after_[cell])) - momentumFlux(indexOf(before_[cell]), cell)) /
         tree_.cells[cell].length;
}

/** Momentum balance of each cell: its new flow as a linear function of the new pressures. */
void FlowNetwork::prepareMomentum()
{
  const double dt = settings_.time_step, theta = settings_.implicitness, density = settings_.density;
  for (std::size_t k = 0; k < tree_.cells.size(); ++k)
    areas_[k] = area(k);
  for (std::size_t k = 0; k < tree_.cells.size(); ++k)
  {
    const FlowCell& cell = tree_.cells[k];
    const FlowObstacle& obstacle = obstacles_[k];
    const double whole = areas_[k], free = whole - obstacle.blocked;
    if (free <= kClosed * whole)
    {
      explicit_flows_[k] = conductances_[k] = 0.0;
      continue;
    }
    const double gain = dt * free / (density * cell.length * cell.inertia);
    const double friction =
        2.0 * (cell.profile + 2.0) * kPi * settings_.viscosity * viscosity_[k] / (density * free) * dt / cell.inertia +
        gain * (obstacle.resistance * viscosity_[k] + obstacle.loss * std::abs(flows_[k]));
    const double difference = pressures_[indexOf(cell.to)] - pressures_[indexOf(cell.from)];
    const double driven = flows_[k] - dt / cell.inertia * convection(k) - (1.0 - theta) * gain * difference;
    explicit_flows_[k] = driven / (1.0 + friction);
    conductances_[k] = theta * gain / (1.0 + friction);
  }
}

void FlowNetwork::step(double inflow, const std::vector<double>& back)
{
  if (back.size() != tree_.outlets.size())
    throw std::invalid_argument("flow network: a back pressure is needed for each outlet");
  for (std::size_t k = 0; k < tree_.outlets.size(); ++k)
  {
    Windkessel outlet = tree_.outlets[k];
    outlet.proximal *= factors_[k];
    outlet.distal *= factors_[k];
    windkessels_[k].prepare(outlet, back[k], settings_.time_step);
  }
  prepareMomentum();
  old_flows_ = flows_;
  solve(inflow);
  for (std::size_t k = 0; k < tree_.cells.size(); ++k)
  {
    const FlowCell& cell = tree_.cells[k];
    flows_[k] = explicit_flows_[k] - conductances_[k] * (pressures_[indexOf(cell.to)] - pressures_[indexOf(cell.from)]);
  }
  updateVolumes(inflow);
}

/** Newton's method for the volume balance of all nodes: V(P) = V_old + Δt Σ θ-weighted flows. */
void FlowNetwork::solve(double inflow)
{
  const double dt = settings_.time_step, theta = settings_.implicitness;
  // Volumes that do not depend on the new pressures.
  std::vector<double>& fixed = fixed_volumes_;
  fixed = volumes_;
  fixed[0] += dt * (theta * inflow + (1.0 - theta) * inflow_);
  for (std::size_t k = 0; k < tree_.cells.size(); ++k)
  {
    const double volume = dt * (theta * explicit_flows_[k] + (1.0 - theta) * old_flows_[k]);
    fixed[indexOf(tree_.cells[k].from)] -= volume;
    fixed[indexOf(tree_.cells[k].to)] += volume;
  }
  for (std::size_t k = 0; k < tree_.outlets.size(); ++k)
    fixed[indexOf(tree_.outlets[k].node)] -= dt * windkessels_[k].constant();
  for (const Source& source : sources_)
    fixed[source.node] += dt * source.flow;
  for (int pass = 0; pass < kMostPasses; ++pass)
  {
    const double error = linearise();
    if (pass >= kPasses && error < kVolumeError)
      return;
    eliminate();
    // Without this bound, the volume balance of a closed node out of which more flows than it holds has no solution.
    for (std::size_t node = 0; node < volumes_.size(); ++node)
      pressures_[node] = std::max(right_side_[node], smallest_pressures_[node]);
  }
}

/** Linear system of the volume balance at the present pressures.
 *  @return largest difference of a volume to that of the linear system before, relative to the volume; without nodes
 *          at a vacuum */
double FlowNetwork::linearise()
{
  double error = 0.0;
  for (std::size_t node = 0; node < volumes_.size(); ++node)
  {
    const double excess = pressures_[node] - settings_.reference_pressure;
    double volume = 0.0, compliance = 0.0;
    for (const HalfCell& half : halves_[node])
    {
      const TubeLaw& wall = tree_.cells[half.cell].wall;
      volume += half.length * wall.areaAt(excess);
      compliance += half.length * wall.complianceAt(excess);
    }
    const double constant = volume - compliance * pressures_[node];
    if (pressures_[node] > smallest_pressures_[node])
      error = std::max(error, std::abs(volume - constants_[node] - compliances_[node] * pressures_[node]) / volume);
    constants_[node] = constant;
    compliances_[node] = diagonal_[node] = compliance;
    right_side_[node] = fixed_volumes_[node] - constant;
  }
  const double factor = settings_.time_step * settings_.implicitness;
  for (std::size_t k = 0; k < tree_.cells.size(); ++k)
  {
    diagonal_[indexOf(tree_.cells[k].from)] += factor * conductances_[k];
    diagonal_[indexOf(tree_.cells[k].to)] += factor * conductances_[k];
  }
  for (std::size_t k = 0; k < tree_.outlets.size(); ++k)
    diagonal_[indexOf(tree_.outlets[k].node)] += settings_.time_step * windkessels_[k].slope();
  return error;
}

/** Solves the linear system on the tree, from the leaves to the root and back. Its solution replaces right_side_. */
void FlowNetwork::eliminate()
{
  const double factor = settings_.time_step * settings_.implicitness;
  for (std::size_t node = volumes_.size(); node-- > 1;)
  {
    const std::size_t parent = indexOf(tree_.cells[cell_to_[node]].from);
    const double weight = factor * conductances_[cell_to_[node]];
    const double multiplier = weight / diagonal_[node];
    diagonal_[parent] -= weight * multiplier;
    right_side_[parent] += multiplier * right_side_[node];
  }
  right_side_[0] /= diagonal_[0];
  for (std::size_t node = 1; node < volumes_.size(); ++node)
  {
    const std::size_t parent = indexOf(tree_.cells[cell_to_[node]].from);
    const double weight = factor * conductances_[cell_to_[node]];
    right_side_[node] = (right_side_[node] + weight * right_side_[parent]) / diagonal_[node];
  }
}

/** Volumes from the flows of the step, and pressures from the volumes. */
void FlowNetwork::updateVolumes(double inflow)
{
  const double dt = settings_.time_step, theta = settings_.implicitness;
  const double in = dt * (theta * inflow + (1.0 - theta) * inflow_);
  volumes_[0] += in;
  entered_ += in;
  inflow_ = inflow;
  for (std::size_t k = 0; k < tree_.cells.size(); ++k)
  {
    const double volume = dt * (theta * flows_[k] + (1.0 - theta) * old_flows_[k]);
    volumes_[indexOf(tree_.cells[k].from)] -= volume;
    volumes_[indexOf(tree_.cells[k].to)] += volume;
  }
  for (std::size_t k = 0; k < tree_.outlets.size(); ++k)
  {
    Windkessel outlet = tree_.outlets[k];
    outlet.proximal *= factors_[k];
    outlet.distal *= factors_[k];
    const std::size_t node = indexOf(outlet.node);
    outflows_[k] = windkessels_[k].accept(outlet, pressures_[node]);
    volumes_[node] -= dt * outflows_[k];
    left_ += dt * outflows_[k];
  }
  for (const Source& source : sources_)
  {
    volumes_[source.node] += dt * source.flow;
    injected_ += dt * source.flow;
  }
  limitOutflows();
  for (std::size_t node = 0; node < volumes_.size(); ++node)
    pressures_[node] = pressureOf(node, volumes_[node]);
}

/** Reduces flows out of nodes that they would empty: the blood behind a closed valve or balloon may be faster than the
 *  wall can follow, and at a vacuum it stops. What flowed in the step before cannot be reduced; it is supplied. */
void FlowNetwork::limitOutflows()
{
  const double dt_theta = settings_.time_step * settings_.implicitness;
  for (std::size_t node = 0; node < volumes_.size(); ++node)
  {
    const double lack = smallest_volumes_[node] - volumes_[node];
    if (lack <= 0.0)
      continue;
    double out = 0.0;
    for (const HalfCell& half : halves_[node])
      out += dt_theta * std::max(flowFrom(node, half.cell), 0.0);
    const double share = out > lack ? lack / out : 1.0;
    for (const HalfCell& half : halves_[node])
    {
      const double flow = flowFrom(node, half.cell);
      if (flow <= 0.0)
        continue;
      const FlowCell& cell = tree_.cells[half.cell];
      const std::size_t other = indexOf(cell.from) == node ? indexOf(cell.to) : indexOf(cell.from);
      volumes_[node] += dt_theta * share * flow;
      volumes_[other] -= dt_theta * share * flow;
      flows_[half.cell] *= 1.0 - share;
    }
  }
  for (std::size_t node = 0; node < volumes_.size(); ++node)
  {
    const double lack = std::max(smallest_volumes_[node] - volumes_[node], 0.0);
    volumes_[node] += lack;
    supplied_ += lack;
  }
}

/** Flow of a cell out of a node at one of its ends [m³/s]. */
double FlowNetwork::flowFrom(std::size_t node, std::size_t cell) const
{
  return indexOf(tree_.cells[cell].from) == node ? flows_[cell] : -flows_[cell];
}

/** Pressure at which the half cells of a node have a volume [Pa]; Newton's method from the present pressure. */
double FlowNetwork::pressureOf(std::size_t node, double volume) const
{
  double excess = pressures_[node] - settings_.reference_pressure;
  for (int pass = 0; pass < kMostScalarPasses; ++pass)
  {
    const double error = volumeAt(node, excess) - volume;
    if (std::abs(error) <= 1e-14 * volume)
      break;
    excess -= error / complianceAt(node, excess);
  }
  return excess + settings_.reference_pressure;
}

double FlowNetwork::totalVolume() const
{
  return std::accumulate(volumes_.begin(), volumes_.end(), 0.0);
}

void FlowNetwork::archive(Archive& archive)
{
  archive(pressures_, volumes_, flows_, outflows_, inflow_, entered_, left_, supplied_);
  const bool is_whole = pressures_.size() == indexOf(tree_.nodes) && volumes_.size() == pressures_.size() &&
                        flows_.size() == tree_.cells.size() && outflows_.size() == tree_.outlets.size();
  if (!is_whole)
    throw ArchiveError("holds the flow of another vessel");
  for (WindkesselState& state : windkessels_)
    state.archive(archive);
}

}  // namespace endovascular_sim::flow
