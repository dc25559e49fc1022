#include "flow/body/body_flow.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/text/format.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kAortaRadius = 9e-3;     // of an inlet that carries the whole cardiac output, or above [m]
constexpr double kAortaDiameter = 25e-3;  // usual one, for the share of a smaller inlet [m]
constexpr double kLeastRest = 1e-3;       // share of the output for which the inlet has no outlet of its own
constexpr double kLeastNamedRest = 5e-3;  // share of the cardiac output that is worth a remark
constexpr double kProximalShare = 0.3;    // largest one of a resistance in front of the compliance
constexpr double kMeanMuscle = 0.45;      // mean pressure in the left ventricle, relative to that in the aorta
constexpr int kSettling = 8, kRounds = 12, kBeatsOfRound = 3;  // of the calibration

double cube(double x)
{
  return x * x * x;
}

/** Share of the cardiac output that enters a vessel. */
double entering(double inlet_radius, double named)
{
  if (inlet_radius >= kAortaRadius)
    return 1.0;
  return std::clamp(cube(2.0 * inlet_radius / kAortaDiameter), named, 1.0);
}

/** Mean flow of each outlet of a vessel at rest [m³/s]. The last one is the rest, which leaves at the inlet; 0 without
 * a rest. */
std::vector<double> meanFlows(const VesselFlowTree& vessel, const Circulation& circulation,
                              std::vector<std::string>& remarks)
{
  const std::size_t territories = circulation.territories.size();
  std::vector<double> cubes(territories + 1, 0.0);  // the last one: outlets without a territory
  const auto groupOf = [&](const OutletPlace& outlet)
  { return outlet.territory < 0 ? territories : static_cast<std::size_t>(outlet.territory); };
  int unnamed = 0;
  for (const OutletPlace& outlet : vessel.outlets)
  {
    cubes[groupOf(outlet)] += cube(outlet.radius);
    unnamed += outlet.territory < 0 ? 1 : 0;
  }
  double named = 0.0;
  for (std::size_t t = 0; t < territories; ++t)
    named += cubes[t] > 0.0 ? circulation.territories[t].share : 0.0;
  const double enters = entering(vessel.inlet_radius, named);
  const double of_unnamed = unnamed > 0 ? enters - named : 0.0;
  if (unnamed > 0)
    remarks.push_back(
        formatted("%d outlets without a known name share %.3g %% of the cardiac output by the cubes of "
                  "their diameters",
                  unnamed, 100.0 * of_unnamed));
  std::vector<double> flows;
  for (const OutletPlace& outlet : vessel.outlets)
  {
    const double share = outlet.territory < 0 ? of_unnamed : circulation.territories[groupOf(outlet)].share;
    flows.push_back(circulation.heart.output * share * cube(outlet.radius) / cubes[groupOf(outlet)]);
  }
  const double rest = 1.0 - named - of_unnamed;
  flows.push_back(rest > kLeastRest ? rest * circulation.heart.output : 0.0);
  if (rest > kLeastNamedRest)
    remarks.push_back(formatted("%.3g %% of the cardiac output leaves at the inlet, for branches that the vessel lacks",
                                100.0 * rest));
  return flows;
}

/** Adds windkessels for mean flows to the outlets of a vessel, and removes outlets without flow. */
void addWindkessels(VesselFlowTree& vessel, const Circulation& circulation, std::vector<double>& flows,
                    std::vector<double>& muscles)
{
  std::vector<double> kept;
  for (std::size_t k = 0; k < flows.size(); ++k)
  {
    if (flows[k] <= 0.0)
      continue;
    const bool is_rest = k == vessel.outlets.size();
    const int node = is_rest ? 0 : vessel.outlets[k].node;
    const int territory = is_rest ? -1 : vessel.outlets[k].territory;
    const double muscle = territory < 0 ? 0.0 : circulation.territories[static_cast<std::size_t>(territory)].muscle;
    const double back = std::max(circulation.venous_pressure, muscle * kMeanMuscle * circulation.mean_pressure);
    const double resistance = (circulation.mean_pressure - back) / flows[k];
    Windkessel outlet;
    outlet.node = node;
    // The rest leaves through the aorta that the vessel lacks.
    const double radius = is_rest ? std::max(vessel.inlet_radius, 0.5 * kAortaDiameter) : vessel.outlets[k].radius;
    const double speed = std::sqrt(2.0 / 3.0 * circulation.wall.at(radius) / circulation.density);
    const double impedance = circulation.density * speed / (kPi * radius * radius);
    outlet.proximal =
        muscle > 0.0 ? circulation.muscle_proximal * resistance : std::min(kProximalShare * resistance, impedance);
    outlet.distal = resistance - outlet.proximal;
    outlet.compliance = (muscle > 0.0 ? circulation.muscle_decay : circulation.decay) / resistance;
    vessel.tree.outlets.push_back(outlet);
    kept.push_back(flows[k]);
    muscles.push_back(muscle);
  }
  flows = kept;
}

FlowSettings settingsOf(const Circulation& circulation, double time_step)
{
  FlowSettings settings;
  settings.density = circulation.density;
  settings.viscosity = circulation.viscosity;
  settings.reference_pressure = circulation.wall.pressure;
  settings.time_step = time_step;
  return settings;
}

/** Tree with the windkessels of the circulation; fills what depends on them. */
const FlowTree& prepared(VesselFlowTree& vessel, const Circulation& circulation, std::vector<double>& targets,
                         std::vector<double>& muscles, std::vector<std::string>& remarks)
{
  targets = meanFlows(vessel, circulation, remarks);
  addWindkessels(vessel, circulation, targets, muscles);
  return vessel.tree;
}

}  // namespace

BodyFlow::BodyFlow(const vessel::CentrelineTree& centreline, const Circulation& circulation, double time_step,
                   const std::vector<bool>& fine)
  : circulation_(circulation),
    vessel_(vesselFlowTree(centreline, circulation, {}, fine)),
    network_(prepared(vessel_, circulation_, targets_, muscle_, remarks_), settingsOf(circulation, time_step),
             circulation.mean_pressure),
    obstruction_(vessel_, network_.settings()),
    heart_(circulation.heart),
    mean_pressure_(circulation.mean_pressure),
    back_(targets_.size(), circulation.venous_pressure),
    calibration_(targets_.size(), 1.0)
{
  calibrate();
}

void BodyFlow::step()
{
  heart_.advance(network_.settings().time_step);
  const double ventricle = ventriclePressure();
  for (std::size_t k = 0; k < back_.size(); ++k)
    back_[k] = std::max(circulation_.venous_pressure, muscle_[k] * ventricle);
  network_.step(heart_.inflow(rootPressure()), back_);
}

/** Runs whole beats. @param flows, pressure mean values of the last one */
void BodyFlow::runBeats(int beats, std::vector<double>& flows, double& pressure)
{
  flows.assign(back_.size(), 0.0);
  pressure = 0.0;
  const unsigned end = heart_.beats() + static_cast<unsigned>(beats);
  int samples = 0;
  while (heart_.beats() < end)
  {
    step();
    if (heart_.beats() + 1 < end)
      continue;
    ++samples;
    pressure += rootPressure();
    for (std::size_t k = 0; k < flows.size(); ++k)
      flows[k] += network_.outflow(k);
  }
  pressure /= samples;
  for (double& flow : flows)
    flow /= samples;
}

/** Chooses the factors of the resistances such that mean flows and mean pressure are those at rest. */
void BodyFlow::calibrate()
{
  std::vector<double> flows;
  double pressure = 0.0;
  runBeats(kSettling, flows, pressure);
  for (int round = 0; round < kRounds; ++round)
  {
    for (std::size_t k = 0; k < flows.size(); ++k)
      calibration_[k] *= std::clamp(flows[k] / targets_[k] * circulation_.mean_pressure / pressure, 0.5, 2.0);
    setFactors();
    runBeats(kBeatsOfRound, flows, pressure);
  }
}

void BodyFlow::setFactors()
{
  for (std::size_t k = 0; k < calibration_.size(); ++k)
  {
    const double dilation = is_hyperaemic_ && muscle_[k] > 0.0 ? 1.0 / circulation_.hyperaemia : 1.0;
    network_.setResistanceFactor(k, calibration_[k] * dilation * mean_pressure_ / circulation_.mean_pressure);
  }
}

void BodyFlow::setHyperaemia(bool is_on)
{
  is_hyperaemic_ = is_on;
  setFactors();
}

void BodyFlow::setMeanPressure(double pressure)
{
  mean_pressure_ = pressure;
  setFactors();
}

void BodyFlow::setObstruction(const std::vector<LumenProfile>& lumens, const std::vector<InstrumentSpan>& instruments)
{
  for (const std::size_t cell : obstruction_.update(lumens, instruments))
    network_.setObstacle(cell, obstruction_.obstacle(cell));
}

std::size_t BodyFlow::cellAt(int branch, double arc) const
{
  const CellRange range = branch >= 0 && branch < static_cast<int>(vessel_.ranges.size())
                              ? vessel_.ranges[static_cast<std::size_t>(branch)]
                              : CellRange{};
  if (range.begin == range.end)
    return 0;
  const auto first = vessel_.places.begin() + static_cast<std::ptrdiff_t>(range.begin);
  const auto last = vessel_.places.begin() + static_cast<std::ptrdiff_t>(range.end) - 1;
  return static_cast<std::size_t>(
      std::partition_point(first, last, [arc](const CellPlace& place) { return place.end < arc; }) -
      vessel_.places.begin());
}

double BodyFlow::pressureAt(int branch, double arc) const
{
  const std::size_t cell = cellAt(branch, arc);
  const double from = network_.pressure(static_cast<std::size_t>(vessel_.tree.cells[cell].from));
  const double to = network_.pressure(static_cast<std::size_t>(vessel_.tree.cells[cell].to));
  const double area = network_.area(cell) - network_.obstacle(cell).blocked;
  return from + obstruction_.dropUpTo(cell, arc, area, network_.flow(cell)) * (to - from);
}

double BodyFlow::flowAt(int branch, double arc) const
{
  return network_.flow(cellAt(branch, arc));
}

void BodyFlow::archive(Archive& archive)
{
  archive(mean_pressure_, is_hyperaemic_);
  heart_.archive(archive);
  network_.archive(archive);
  if (archive.reading())
    setFactors();
}

}  // namespace endovascular_sim::flow
