#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "flow/network/flow_network.h"

namespace endovascular_sim::flow
{

/** Uniform elastic vessel. */
struct UniformVessel
{
  double length = 0.1;      ///< [m]
  double radius = 2e-3;     ///< at the reference pressure [m]
  double wave_speed = 6.0;  ///< at the reference pressure [m/s]
  double profile = 2.0;
  double inertia = 1.0;
};

/** β of a wave speed: c² = β/(2ρ) at the reference pressure [Pa]. */
inline double stiffnessOf(double wave_speed, double density)
{
  return 2.0 * density * wave_speed * wave_speed;
}

/** Appends a vessel from a node. @return its last node */
inline int append(FlowTree& tree, int from, const UniformVessel& vessel, int cells, double density)
{
  constexpr double kPi = 3.14159265358979323846;
  const int segment = tree.cells.empty() ? 0 : tree.cells.back().segment + 1;
  for (int k = 0; k < cells; ++k)
  {
    FlowCell cell;
    cell.from = from;
    cell.to = from = tree.nodes++;
    cell.segment = segment;
    cell.length = vessel.length / cells;
    cell.wall = {kPi * vessel.radius * vessel.radius, stiffnessOf(vessel.wave_speed, density)};
    cell.profile = vessel.profile;
    cell.inertia = vessel.inertia;
    tree.cells.push_back(cell);
  }
  return from;
}

/** Characteristic impedance ρc/A of a vessel [Pa·s/m³]. */
inline double impedanceOf(const UniformVessel& vessel, double density)
{
  constexpr double kPi = 3.14159265358979323846;
  return density * vessel.wave_speed / (kPi * vessel.radius * vessel.radius);
}

}  // namespace endovascular_sim::flow
