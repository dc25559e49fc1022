#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/contact/wall_friction.h"
#include "rod/kkt/kkt_assembly.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/kkt_system.h"

namespace endovascular_sim::rod
{

/** Accepted solution of a `kkt` system. */
struct KktSolution
{
  const KktModel& model;
  const KktSystem& system;
  const std::vector<double>& unknowns;
  const std::vector<Eigen::Vector3d>& motion;  ///< increment of every node [m]
  const std::vector<Eigen::Vector3d>& begin;   ///< positions at the beginning of the step [m]
  const NodeResistance& resistance;
  double introducer_force;    ///< KktAssembly::configurationalForce() [N]
  double rest_force;          ///< LayerModel::restForce() [N]
  const LayerSlides* slides;  ///< null: every mass moves with its node
  const WallFriction& friction;
  const std::vector<NodalForce>& forces;
  const std::vector<NodalDrag>& drags;
  double dt;                                  ///< [s]
  const contact::WallTravel* wall = nullptr;  ///< motion of wall and fluid in the step; null: they rest
};

/** Tensions of the edges, reaction forces at the held ends, and the parts of the force on the hand. */
class KktReactions
{
public:
  /** Updates the state's tensions and forces from a solution, after its motion. */
  void update(const KktSolution& solution, State& state);

private:
  void updateHandParts(const KktSolution& solution, State& state);

  std::vector<Eigen::Vector3d> slide_;  ///< velocity of every node when the wire slides along itself [1]
};

}  // namespace endovascular_sim::rod
