#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/linear/banded_ldlt.h"

namespace endovascular_sim::rod
{

/** Node of a wire in the bore of another. Vectors have the two components of a frame across the centreline that does
 *  not turn about it (Bishop frame). */
struct BoreNode
{
  double cell = 0.0;                                    ///< length of the node's cell [m]
  double edge = 0.0;                                    ///< length of the edge after the node [m]
  double stiffness = 0.0;                               ///< bending stiffness of the wire [N·m²]
  double clearance = 0.0;                               ///< largest distance between wire and centreline [m]
  double wall = 0.0;                                    ///< part of the node with a wall, 0 to 1
  double tension = 0.0;                                 ///< on the edge after the node [N]
  Eigen::Vector2d curvature = Eigen::Vector2d::Zero();  ///< of the centreline, towards its centre [1/m]
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();     ///< stiffness times strain of the wire on the centreline [N·m]
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();      ///< of the wire from the centreline [m]
};

/** Lateral equilibrium of a wire in a bore around a given centreline (docs/PHYSICS.md, "Friction between layers").
 *
 *  The wire is a beam under tension. It may bear on any side of the bore, or on none. With the shift u across the
 *  centreline, small against the radius of a bend, the equilibrium is the minimum of
 *
 *      ∫ M·u″ + ½ B |u″|² + ½ T |u′|² − T κ·u + ½ k (|u| − c)₊² ds.
 *
 *  Compression has no part in ½ T |u′|². The energy is therefore convex: the equilibrium is unique, and its loads are a
 *  continuous function of the data. */
class BoreContact
{
public:
  /** Computes the shifts of all nodes but the first two, which stay on the centreline. The last two nodes belong to the
   *  wire beyond the bore: their moments are given, those of all other nodes follow from the shifts.
   *  @param nodes with the shifts of the last solution, or zero; at least five, the last one without a shift */
  void solve(std::vector<BoreNode>& nodes);

  /** Force of the wire on the bore at every node of the last solution [N/m]. */
  const std::vector<double>& load() const { return load_; }

  /** Change of the curvature of the wire with its shift, from the centreline [1/m]; 0 at the nodes of both ends. */
  static Eigen::Vector2d bend(const std::vector<BoreNode>& nodes, std::size_t node);

  int iterations() const { return iterations_; }

private:
  static constexpr int kBandwidth = 5;

  void addElasticity(const std::vector<BoreNode>& nodes);
  void assemble(const std::vector<BoreNode>& nodes);
  double energy(const std::vector<BoreNode>& nodes) const;
  bool improve(std::vector<BoreNode>& nodes);
  void updateLoads(const std::vector<BoreNode>& nodes);

  /** Row of the elastic matrix, which is the same for both components. */
  struct Row
  {
    double own = 0.0, next = 0.0, second = 0.0;  ///< with the node itself and the two after it [N/m]
  };

  std::vector<Row> elastic_;
  std::vector<Eigen::Vector2d> force_;           ///< of the centreline's shape and the tension at every node [N]
  std::vector<Eigen::Vector2d> before_, trial_;  ///< shifts at the beginning, and before the present iteration [m]
  BandedLdlt<kBandwidth, 2> matrix_;
  std::vector<double> rhs_;
  std::vector<double> load_;
  double present_ = 0.0;  ///< energy of the present shifts [J]
  int iterations_ = 0;
};

}  // namespace endovascular_sim::rod
