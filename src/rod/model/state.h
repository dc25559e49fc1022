#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "rod/model/discretisation.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** How far a held distal end has been moved from where it was at the start. */
struct EndMotion
{
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< of the clamp's middle, or of the pinned node [m]
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();          ///< rotation vector of a clamp's direction [rad]
  double rotation = 0.0;  ///< of a clamp that holds the twist, about the wire's axis [rad]
};

/** The motion at a share of the way from one to another, 0 to 1. */
EndMotion between(const EndMotion& from, const EndMotion& to, double share);

/** Parts of the axial force at the hand: the work of everything that acts on the wire when it slides along itself by a
 *  unit of length (docs/PHYSICS.md). Positive where it resists pushing. Not a number where a scheme does not tell. */
struct HandForceParts
{
  double bending = std::numeric_limits<double>::quiet_NaN();   ///< of the wire into the vessel, held by the wall [N]
  double friction = std::numeric_limits<double>::quiet_NaN();  ///< of the wall [N]
  double inertia = std::numeric_limits<double>::quiet_NaN();   ///< [N]
  double drag = std::numeric_limits<double>::quiet_NaN();      ///< of the fluid, and damping [N]
  double load = std::numeric_limits<double>::quiet_NaN();      ///< weight, outside forces, a held distal end [N]
  double valve = 0.0;                                          ///< dry friction of the introducer's valve [N]

  double sum() const { return bending + friction + inertia + drag + load + valve; }
};

/** One of several instruments on one centreline (concentric_stack.h). */
struct LayerState
{
  double inserted_length = 0.0;     ///< of its tip beyond the introducer; negative: not there yet [m]
  double rotation = 0.0;            ///< of its handle [rad]
  double speed = 0.0;               ///< of insertion in the last step [m/s]
  std::vector<double> twist_angle;  ///< material frame against Bishop frame [rad], n−1
  /** How far it was pushed in the next outer layer without sliding there [m]. */
  double friction_stretch = 0.0;
  double friction_turn = 0.0;   ///< mean angle to the next outer layer at which they stick [rad]
  double friction_share = 0.0;  ///< of the friction torque between both that acts, −1 to 1
  std::vector<double> load;     ///< with which it presses on the next outer layer [N/m], n
  double force_offset = 0.0;    ///< in hand_force, since the last change of the reference; fades [N]
  double hand_force = 0.0;      ///< on the hand that holds it, positive when it pushes back [N]
  double hand_torque = 0.0;     ///< that its hand holds [N·m]
};

/** What changes from step to step. Arrays run over all nodes (n) or edges (n−1) of the wire; those before
 *  first_node lie outside the introducer, straight and unsimulated. */
struct State
{
  int first_node = 0;
  double inserted_length = 0.0;              ///< wire beyond the introducer [m]
  double rotation = 0.0;                     ///< of the handle [rad]
  std::vector<Eigen::Vector3d> position;     ///< [m], n
  std::vector<Eigen::Vector3d> velocity;     ///< [m/s], n
  std::vector<double> tension;               ///< multiplier of inextensibility [N], n−1
  std::vector<Eigen::Vector3d> moment;       ///< bending moment in space, schemes that solve for it only [N·m], n
  std::vector<double> twist_angle;           ///< material frame against Bishop frame [rad], n−1
  std::vector<Eigen::Vector3d> wall_force;   ///< normal force of the wall on each node [N], n
  std::vector<double> friction_coefficient;  ///< of the contact that pushes on each node, n
  /** How far the wall's friction has been dragged without sliding, at most StepperSettings::friction_slip [m], n. */
  std::vector<Eigen::Vector3d> friction_stretch;
  /** By how much each node's contacts count as further from the wall than they are [m], n: a change of nodes must not
   *  change forces. It fades. Not a number where the nodes have changed since the last step. */
  std::vector<double> wall_offset;
  /** Curvature binormal in space that does not bend back at each node [1], n: as above, for moments. */
  std::vector<Eigen::Vector3d> curvature_offset;
  double hand_force = 0.0;   ///< axial force of the wire on the hand, positive when it pushes back [N]
  double hand_torque = 0.0;  ///< torque that the hand holds about the wire's axis [N·m]

  HandForceParts hand_parts;  ///< of hand_force
  double valve_torque = 0.0;  ///< part of hand_torque [N·m]
  /** How far the valve's friction has been dragged along and about the wire without sliding [m]. */
  Eigen::Vector2d valve_stretch = Eigen::Vector2d::Zero();

  /** Of a stack of instruments, from the inside out; empty for one wire. What is said of the wire above then holds for
   *  the reference, the layer that reaches furthest, except the hand's force and torque: they are sums over all. */
  std::vector<LayerState> layers;
  int reference = 0;  ///< the layer whose material the nodes follow

  EndMotion distal;            ///< where the held distal end is
  double tip_transport = 0.0;  ///< angle from the Bishop frame to a held tip's director, over full turns [rad]
  double distal_torque = 0.0;  ///< torque that a clamp of the distal end's twist holds about the wire's axis [N·m]
  Eigen::Vector3d distal_anchor = Eigen::Vector3d::Zero();   ///< place of the held distal end at the start [m]
  Eigen::Vector3d proximal_force = Eigen::Vector3d::Zero();  ///< of the wire on what holds its proximal end [N]
  Eigen::Vector3d distal_force = Eigen::Vector3d::Zero();    ///< and on a held distal end [N]

  /** 64-bit hash over the positions and twist angles, of all layers, from first_node on, as IEEE-754 bytes. */
  std::uint64_t hash() const;
};

/** Position of the handle of one instrument, and its reaction. */
struct HandleState
{
  double inserted_length = 0.0;  ///< tip beyond the introducer; negative: outside [m]
  double rotation = 0.0;         ///< [rad]
  double force = 0.0;            ///< on the hand, positive when it pushes back [N]
  double torque = 0.0;           ///< that the hand holds [N·m]
};

/** Handle of one of the instruments of a state. */
HandleState handleState(const State& state, int instrument);

/** Saves or loads all of a state. */
void archive(Archive& archive, State& state);

/** Elastic energies of the simulated part of the wire [J]. */
struct Energy
{
  double bending = 0.0;
  double twist = 0.0;
  double stretch = 0.0;
};

/** Largest | |e|/|ē| − 1 | over the simulated edges. */
double maxStrain(const Discretisation& rod, const State& state);

}  // namespace endovascular_sim::rod
