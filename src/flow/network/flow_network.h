#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "flow/boundary/windkessel.h"
#include "flow/network/tube_law.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::flow
{

/** Piece of an unbranched vessel between two nodes of the network. */
struct FlowCell
{
  int from = 0;          ///< node nearer to the heart
  int to = 0;            ///< node farther from it, with a larger index
  int segment = 0;       ///< number of the unbranched vessel; convection acts between cells of one segment
  double length = 0.0;   ///< Δx [m]
  TubeLaw wall;          ///< area and stiffness
  double profile = 2.0;  ///< γ of the velocity profile (γ+2)/γ·(1 − (r/R)^γ): 2 Poiseuille, 9 nearly flat
  double inertia = 1.0;  ///< factor of the inertia; 4/3 for oscillations of a Poiseuille profile (Olufsen 1999)
};

/** Geometry of a network: a tree of cells with node 0 at the heart. Every other node is the `to` of one cell. */
struct FlowTree
{
  int nodes = 1;
  std::vector<FlowCell> cells;
  std::vector<Windkessel> outlets;
};

/** Properties of the blood, and of the scheme. */
struct FlowSettings
{
  double density = 1060.0;          ///< ρ [kg/m³]
  double viscosity = 4e-3;          ///< µ [Pa·s]
  double reference_pressure = 0.0;  ///< P₀ of all walls [Pa]
  double time_step = 1e-3;          ///< [s]
  double implicitness = 0.55;       ///< θ of the pressure; below 0.55 stiff vessels oscillate
  double momentum_factor = 1.0;     ///< α of the convection
};

/** Obstacle in a cell. */
struct FlowObstacle
{
  double blocked = 0.0;     ///< area that instruments take [m²]
  double resistance = 0.0;  ///< in addition to that of the blood in the free cell: Δp/Q [Pa·s/m³]
  double loss = 0.0;        ///< Δp/(Q|Q|) [Pa·s²/m⁶]

  bool operator==(const FlowObstacle& other) const
  {
    return blocked == other.blocked && resistance == other.resistance && loss == other.loss;
  }
};

/** One-dimensional flow of blood in a tree of elastic vessels:
 *
 *      ∂A/∂t + ∂Q/∂x = 0,
 *      ι ∂Q/∂t + ∂(αQ²/A)/∂x + (A/ρ) ∂P/∂x = −2(γ+2)πνQ/A − (A/ρΔx)(R + K|Q|) Q.
 *
 *  The grid is staggered: pressure and volume at nodes, flow in cells. The pressure is implicit with the weight θ,
 *  friction and losses are fully implicit, convection is explicit and upwind. The volumes are nonlinear functions of
 *  the pressure; Newton's method leads to symmetric linear systems on the tree, which are eliminated from the leaves to
 *  the root in O(n) (Casulli, Dumbser & Toro 2012). The scheme is stable at any time step.
 *
 *  Volumes are updated by fluxes and pressures follow from volumes, so that blood is conserved up to rounding. */
class FlowNetwork
{
public:
  /** @param pressure initial pressure everywhere [Pa]
   *  @throws std::invalid_argument when the cells are no tree, or a value is not positive */
  FlowNetwork(FlowTree tree, const FlowSettings& settings, double pressure);

  const FlowTree& tree() const { return tree_; }
  const FlowSettings& settings() const { return settings_; }

  /** Sets what is in a cell from the next step on. An area that is blocked as a whole closes the cell. */
  void setObstacle(std::size_t cell, const FlowObstacle& obstacle) { obstacles_[cell] = obstacle; }
  const FlowObstacle& obstacle(std::size_t cell) const { return obstacles_[cell]; }
  /** Scales the resistances of an outlet from the next step on, e.g. by 1/3.5 in hyperaemia. */
  void setResistanceFactor(std::size_t outlet, double factor);

  /** Fluid that enters at a node in every step from the next one on, e.g. through an instrument.
   *  @param flow mean of each step [m³/s]; 0 ends it */
  void setSource(std::size_t node, double flow);
  void clearSources() { sources_.clear(); }
  /** Scales the viscosity of the blood in a cell from the next step on, e.g. where contrast medium is mixed with it. */
  void setViscosityFactor(std::size_t cell, double factor);

  /** Advances by one time step.
   *  @param inflow at node 0 at its end [m³/s]
   *  @param back for each outlet: pressure behind it at its end [Pa] */
  void step(double inflow, const std::vector<double>& back);

  double pressure(std::size_t node) const { return pressures_[node]; }    ///< [Pa]
  double volume(std::size_t node) const { return volumes_[node]; }        ///< of the half cells at a node [m³]
  double flow(std::size_t cell) const { return flows_[cell]; }            ///< [m³/s], positive away from the heart
  double outflow(std::size_t outlet) const { return outflows_[outlet]; }  ///< in the last step [m³/s]
  /** Area of the lumen of a cell, with what blocks it [m²]. */
  double area(std::size_t cell) const { return tree_.cells[cell].wall.areaAt(meanExcess(cell)); }
  /** The same without what blocks it, at least a hundredth of it [m²]. */
  double freeArea(std::size_t cell) const
  {
    return std::max(area(cell) - obstacles_[cell].blocked, kLeastFree * area(cell));
  }
  double totalVolume() const;  ///< [m³]

  /** Volume that has entered through node 0 and left through the outlets since the beginning [m³]. */
  double entered() const { return entered_; }
  double left() const { return left_; }
  double injected() const { return injected_; }  ///< volume that sources have added since the beginning [m³]
  /** Volume that was added where inertia would have emptied a vessel [m³]; zero in all but sudden closures. */
  double supplied() const { return supplied_; }

  /** Mean flow of a cell over the last step, which moved its blood [m³/s]. */
  double meanFlow(std::size_t cell) const
  {
    return settings_.implicitness * flows_[cell] + (1.0 - settings_.implicitness) * old_flows_[cell];
  }

  /** The part that changes: obstacles, factors and sources are set again by the owner, and injected() by
   *  setInjected(), so that archives of a network without sources do not hold it.
   *  @throws ArchiveError for an archive of another tree; the network must not be used afterwards */
  void archive(Archive& archive);
  void setInjected(double volume) { injected_ = volume; }  ///< [m³]

private:
  double excess(int node) const { return pressures_[static_cast<std::size_t>(node)] - settings_.reference_pressure; }
  double meanExcess(std::size_t cell) const;
  double volumeAt(std::size_t node, double excess) const;
  double complianceAt(std::size_t node, double excess) const;
  double convection(std::size_t cell) const;
  double momentumFlux(std::size_t left, std::size_t right) const;
  void check() const;
  void link();
  void prepareMomentum();
  void solve(double inflow);
  double linearise();
  void eliminate();
  void updateVolumes(double inflow);
  void limitOutflows();
  double flowFrom(std::size_t node, std::size_t cell) const;
  double pressureOf(std::size_t node, double volume) const;

  static constexpr double kLeastFree = 0.01;  // share of an area

  struct HalfCell
  {
    std::size_t cell;
    double length;  // [m]
  };

  /** Fluid that enters at a node. */
  struct Source
  {
    std::size_t node;
    double flow;  // [m³/s]
  };

  FlowTree tree_;
  FlowSettings settings_;
  std::vector<std::vector<HalfCell>> halves_;  // of each node
  std::vector<std::size_t> cell_to_;           // of each node but the first one: the cell that ends there
  std::vector<int> before_, after_;            // of each cell: its neighbours in its segment; −1 without one
  std::vector<FlowObstacle> obstacles_;
  std::vector<double> factors_;    // of the resistances of each outlet
  std::vector<double> viscosity_;  // of each cell, relative to the blood's
  std::vector<Source> sources_;
  std::vector<WindkesselState> windkessels_;
  std::vector<double> pressures_, volumes_, flows_, outflows_;
  std::vector<double> smallest_volumes_, smallest_pressures_;  // of each node, at a vacuum
  double inflow_ = 0.0, entered_ = 0.0, left_ = 0.0, supplied_ = 0.0, injected_ = 0.0;
  std::vector<double> explicit_flows_, conductances_;  // of each cell: Q = explicit − conductance·(P_to − P_from)
  std::vector<double> old_flows_, areas_;
  std::vector<double> fixed_volumes_, diagonal_, right_side_;
  std::vector<double> constants_, compliances_;  // of each node: V = constant + compliance·P, as linearised last
};

}  // namespace endovascular_sim::flow
