#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "contrast/transport/transport.h"

namespace endovascular_sim::contrast
{

/** Stiff vessel of one branch with a steady flow. */
struct Pipe
{
  static constexpr double kPi = 3.14159265358979323846;

  /** @param count of cells  @param length of all [m] */
  Pipe(int count, double length, double radius, const TransportSettings& settings)
    : Pipe(std::vector<double>(static_cast<std::size_t>(count), kPi * radius * radius * length / count), length / count,
           settings)
  {
  }

  Pipe(std::vector<double> volumes_of_cells, double length_of_cell, const TransportSettings& settings)
    : volumes(std::move(volumes_of_cells)), transport(cellsOf(volumes.size(), length_of_cell), volumes, settings)
  {
    blood.before = blood.after = volumes;
    blood.outflows.assign(volumes.size(), 0.0);
  }

  static ContrastCells cellsOf(std::size_t count, double length)
  {
    ContrastCells cells;
    for (std::size_t k = 0; k < count; ++k)
      cells.push_back(
          {0, static_cast<double>(k) * length, static_cast<double>(k + 1) * length, static_cast<int>(k) - 1});
    return cells;
  }

  /** Moves the blood by a volume, in equal steps. */
  void flow(double volume, int steps)
  {
    blood.outflows.back() = volume / steps;
    for (int k = 0; k < steps; ++k)
      transport.step(blood);
  }

  double concentration(std::size_t cell) const { return transport.concentration(cell, volumes[cell]); }

  std::vector<double> volumes;
  Transport transport;
  BloodStep blood;
};

}  // namespace endovascular_sim::contrast
