#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "rod/boundary/boundary_conditions.h"
#include "rod/contact/wall_friction.h"
#include "rod/energy/potential_energy.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Slide of a layer's surface and of the masses over a node in a step [m]; see LayerSlides. */
struct NodeSlide
{
  Eigen::Vector3d surface = Eigen::Vector3d::Zero();
  Eigen::Vector3d mass = Eigen::Vector3d::Zero();
  Eigen::Vector3d mass_gained = Eigen::Vector3d::Zero();
};

/** Forces of an accepted solution that resist the motion of the nodes. */
struct ResistingForces
{
  std::vector<Eigen::Vector3d> friction;  ///< of the wall along the surface, on every node [N]
  std::vector<double> damping;            ///< per displacement of the masses [N/m]
  std::vector<double> drag;               ///< per displacement of the surface [N/m]

  void reset(std::size_t nodes);
};

/** Potential energies of a state whose nodes all have a position. @param from first node whose weight counts */
using PotentialFunction = std::function<PotentialEnergy(const State& state, int from)>;

/** Part of a step that a scheme has accepted. */
struct AcceptedPart
{
  const State& before;
  const State& after;
  const std::vector<Eigen::Vector3d>& begin;  ///< positions at the beginning, those of entering nodes extrapolated [m]
  const StepInput& input;
  double dt;  ///< [s]
  const Discretisation& rod;
  const Boundary& boundary;
  const BoundaryConditions& conditions;
  const PotentialFunction& potential;
  const ResistingForces& forces;
  const std::vector<NodeSlide>& slides;            ///< empty: every mass moves with its node
  const std::vector<TwistFriction>& about_axis;    ///< friction of the wall in the last relaxation of the twist
  const std::vector<double>& surface_begin;        ///< angle of the surface at every node before the part [rad]
  const std::vector<double>& surface_angle;        ///< after the part [rad]
  const std::vector<double>& frame_turns;          ///< of the Bishop frame of every edge [rad]; empty: neglected
  double wall_energy;                              ///< springs of contacts after the part [J]
  double layer_friction_push;                      ///< work of the friction between layers along the wire [J]
  double layer_friction_turn;                      ///< about the wire [J]
  double insertion_work;                           ///< of the hands, on the potentials at fixed nodes [J]
  const contact::WallTravel* wall = nullptr;       ///< motion of wall and fluid in the part; null: they rest
  const std::vector<double>* wall_turn = nullptr;  ///< SurfaceMotion::wall_turn
};

}  // namespace endovascular_sim::rod
