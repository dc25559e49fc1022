#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/kkt/kkt_model.h"
#include "rod/kkt/kkt_system.h"
#include "rod/kkt/layer_model.h"
#include "rod/model/bending_pair.h"

namespace endovascular_sim::rod
{

/** Iterate about which a system is assembled. */
struct KktIterate
{
  const State& state;
  const std::vector<Eigen::Vector3d>& begin;  ///< positions at the beginning of the step [m]
  const TwistAction& twist;
  const LayerSlides* slides;  ///< null: every mass moves with its node
  const std::vector<NodalForce>& forces;
  double dt;         ///< [s]
  bool first_solve;  ///< drag at the velocities of the last step; else at the motion so far
};

/** Resistance of fluid and damping to the motion of every node. */
struct NodeResistance
{
  std::vector<double> coefficient;     ///< force per travel, times Δt² [kg]
  std::vector<Eigen::Vector3d> slide;  ///< the same times the slide of the node's masses and surface [kg·m]
};

/** Assembly of the `kkt` system: bending, inextensibility, inertia, weight, drag, external forces, the introducer. */
class KktAssembly
{
public:
  /** @param model, system must outlive this */
  KktAssembly(const KktModel& model, KktSystem& system) : model_(model), system_(system) {}

  /** Assembles the system of an iterate; system.first is the state's first node. */
  void assemble(const KktIterate& at);

  /** Adds bending and the forces of the twist alone. */
  void addAllBending(const KktIterate& at);

  /** Energy of the introducer's guide and of its tube: their forces are its derivatives by the positions [J]. */
  double introducerEnergy(const State& state) const;

  /** Resistances in the system assembled last. */
  const NodeResistance& resistance() const { return resistance_; }

private:
  /** Point of the wire at the introducer's mouth. */
  struct MouthPoint
  {
    int edge = 0;
    double parameter = 0.0;  ///< on the edge; outside 0 to 1: no such point
  };

  BendingPairInput bendingInput(int first, int second, const KktIterate& at) const;
  void addBending(int first, int second, const BendingPair& bending);
  void addConstraint(int edge, const KktIterate& at);
  void addMouth(const KktIterate& at);
  MouthPoint mouthPoint(const State& state) const;
  double sheathEnergy(int edge, double parameter, const State& state) const;
  void addSheath(int edge, double parameter, const KktIterate& at);
  void addNodeTerms(int node, const KktIterate& at);
  void addGuide(int node, const KktIterate& at, Eigen::Vector3d& residual);
  void addDiagonal(int node, double value);
  void addBlock(int node, const Eigen::Matrix3d& block);

  const KktModel& model_;
  KktSystem& system_;
  NodeResistance resistance_;
};

}  // namespace endovascular_sim::rod
