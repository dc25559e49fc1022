#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/boundary/curved_guide.h"
#include "rod/boundary/introducer_guide.h"
#include "rod/boundary/introducer_sheath.h"
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
  const std::vector<NodalDrag>& drags;
  double dt;                                  ///< [s]
  bool first_solve;                           ///< drag at the velocities of the last step; else at the motion so far
  const contact::WallTravel* wall = nullptr;  ///< motion of wall and fluid in the step; null: they rest
};

/** Resistance of fluid and damping to the motion of every node. */
struct NodeResistance
{
  std::vector<double> coefficient;  ///< force per travel, times Δt² [kg]
  /** The same times the slide of the node's masses and surface, less the motion of the fluid [kg·m]. */
  std::vector<Eigen::Vector3d> slide;
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

  /** Energy of the introducer's guide and of its sheath: their forces are its derivatives by the positions [J]. */
  double introducerEnergy(const State& state) const;

  /** Minus the derivative of that energy by the arc length at which rest curvature begins to act, at fixed nodes: a
   * part of the force on the hand [N]. */
  double guideRestForce(const State& state) const;

  /** Axial force of the wire on the introducer's guide and sheath in the system assembled last: the configurational
   *  part of the force on the hand [N]. */
  double configurationalForce() const { return configurational_force_; }

  /** Resistances in the system assembled last. */
  const NodeResistance& resistance() const { return resistance_; }

private:
  BendingPairInput bendingInput(int first, int second, const KktIterate& at) const;
  void addBending(int first, int second, const BendingPair& bending);
  void addConstraint(int edge, const KktIterate& at);
  void addIntroducer(const KktIterate& at);
  void addBow(int edge, const CurvedGuideTerm& term, double factor);
  template <typename Visit>
  void visitSheath(const State& state, Visit visit) const;
  void addNodeTerms(int node, const KktIterate& at);
  void addStream(const NodalDrag& drag, const KktIterate& at);
  void addDiagonal(int node, double value);
  void addBlock(int node, const Eigen::Matrix3d& block);
  void addAcross(int row, int col, const Eigen::Matrix3d& block);
  void addForce(int node, const Eigen::Vector3d& force, double factor);

  const KktModel& model_;
  KktSystem& system_;
  IntroducerGuide guide_{model_.boundary};
  CurvedGuide curved_guide_{guide_};
  IntroducerSheath sheath_{model_.boundary};
  NodeResistance resistance_;
  double configurational_force_ = 0.0;  ///< [N]
};

}  // namespace endovascular_sim::rod
