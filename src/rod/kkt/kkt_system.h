#pragma once

#include <vector>

#include "rod/linear/banded_ldlt.h"

namespace endovascular_sim::rod
{

/** Saddle system of one solve, without contacts, friction and prescribed nodes.
 *
 *  Unknowns are interleaved x0, –, x1, λ0, x2, λ1, …: half bandwidth 10, every multiplier after both its nodes, so LDLᵀ
 *  needs no pivoting. The idle unknown that follows x0 gives all nodes the same pattern. Equations are multiplied by
 *  Δt²: the matrix is in kg, the right-hand side in kg·m. */
struct KktSystem
{
  static constexpr int kBandwidth = 10;
  static constexpr int kIdleRow = 3;  ///< row of the multiplier among the four of a node; idle at the first node
  using Matrix = BandedLdlt<kBandwidth, 4>;

  /** Sets the first simulated node and zeroes the system of the nodes from there on. */
  void reset(int first_node, int nodes)
  {
    first = first_node;
    matrix.reset(4 * (nodes - first));
    rhs.assign(static_cast<std::size_t>(matrix.size()), 0.0);
    matrix.at(kIdleRow, kIdleRow) = -scale;
  }

  int row(int node) const { return 4 * (node - first); }
  int multiplierRow(int edge) const { return 4 * (edge - first) + 7; }

  int first = 0;       ///< first simulated node
  double scale = 1.0;  ///< factor on the constraint rows [kg]
  Matrix matrix;
  std::vector<double> rhs;
};

}  // namespace endovascular_sim::rod
