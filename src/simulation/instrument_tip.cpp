#include "simulation/instrument_tip.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kTangentLength = 0.5e-3;  ///< length at the tip that gives its direction [m]

/** Arc length of a point at a length beyond the introducer, from the first node [m]. */
double arcLengthAt(const Simulation& simulation, double inserted)
{
  // Node positions are arc lengths up to the tip of the foremost instrument.
  return simulation.discretisation().position.back() - simulation.state().inserted_length + inserted;
}

/** Parallel transport: the rotation about from × to that takes one unit tangent to the other. */
void transport(Eigen::Vector3d& tangent, const Eigen::Vector3d& to, Eigen::Vector3d& director)
{
  director -= (director.dot(to) / (1.0 + tangent.dot(to))) * (tangent + to);
  tangent = to;
}

}  // namespace

int firstInsertedNode(const Simulation& simulation)
{
  const rod::Discretisation& wire = simulation.discretisation();
  int node = simulation.state().first_node;
  while (simulation.hasIntroducer() && node < wire.nodes() &&
         simulation.state().inserted_length - (wire.length() - wire.position[node]) < 0.0)
    ++node;
  return node;
}

Eigen::Vector3d pointAt(const Simulation& simulation, double inserted)
{
  const rod::State& state = simulation.state();
  const std::vector<double>& arc = simulation.discretisation().position;
  const double target = arcLengthAt(simulation, inserted);
  const auto after = std::upper_bound(arc.begin(), arc.end(), target);
  if (after == arc.begin())
    return state.position.front();
  if (after == arc.end())
    return state.position.back();
  const auto k = static_cast<std::size_t>(after - arc.begin());
  const double share = (target - arc[k - 1]) / (arc[k] - arc[k - 1]);
  return state.position[k - 1] + share * (state.position[k] - state.position[k - 1]);
}

double tipRotation(const Simulation& simulation, int instrument)
{
  const rod::State& state = simulation.state();
  // Beyond the end of a layer its angles are that of its last edge.
  return state.layers.empty() ? state.twist_angle.back()
                              : state.layers[static_cast<std::size_t>(instrument)].twist_angle.back();
}

Eigen::Matrix3d tipFrame(const Simulation& simulation, int instrument)
{
  const rod::State& state = simulation.state();
  const std::vector<double>& arc = simulation.discretisation().position;
  const double inserted = std::max(0.0, simulation.hand(instrument).insertion);
  const double hold = simulation.hasIntroducer() ? arcLengthAt(simulation, 0.0) : 0.0;
  const double tip = arcLengthAt(simulation, inserted - kTangentLength);
  Eigen::Vector3d tangent = simulation.entry().direction;
  Eigen::Vector3d director = simulation.entry().d1;
  for (std::size_t j = static_cast<std::size_t>(state.first_node); j + 1 < arc.size() && arc[j] < tip; ++j)
    if (0.5 * (arc[j] + arc[j + 1]) >= hold)
      transport(tangent, (state.position[j + 1] - state.position[j]).normalized(), director);
  const Eigen::Vector3d chord = pointAt(simulation, inserted) - pointAt(simulation, inserted - kTangentLength);
  transport(tangent, chord.normalized(), director);
  const double turn = tipRotation(simulation, instrument);
  Eigen::Matrix3d frame;
  frame.col(0) = tangent;
  frame.col(1) = std::cos(turn) * director + std::sin(turn) * tangent.cross(director);
  frame.col(2) = tangent.cross(frame.col(1));
  return frame;
}

}  // namespace endovascular_sim::simulation
