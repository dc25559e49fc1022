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

/** Displacement of a held distal end since the start. */
struct EndMotion
{
  Eigen::Vector3d displacement =
      Eigen::Vector3d::Zero();                     ///< translation of the clamp's middle, or the pinned node [m]
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();  ///< rotation vector of a clamp's direction [rad]
  double rotation = 0.0;  ///< rotation about the wire's axis of a clamp that holds the twist [rad]
};

/** Linear interpolation between two motions.
 *  @param share 0 to 1 */
EndMotion between(const EndMotion& from, const EndMotion& to, double share);

/** Parts of the axial force on the hand: the work of the loads when the wire slides along itself by a unit of length
 *  (docs/PHYSICS.md). Positive where a part resists pushing. NaN in schemes that do not compute them. */
struct HandForceParts
{
  double bending = std::numeric_limits<double>::quiet_NaN();   ///< elastic forces, the wall's normal forces, guide [N]
  double friction = std::numeric_limits<double>::quiet_NaN();  ///< friction of the wall [N]
  double inertia = std::numeric_limits<double>::quiet_NaN();   ///< inertial force [N]
  double drag = std::numeric_limits<double>::quiet_NaN();      ///< drag of the fluid, and damping [N]
  double load = std::numeric_limits<double>::quiet_NaN();      ///< weight, external forces, a held distal end [N]
  double valve = 0.0;                                          ///< dry friction of the introducer's valve [N]
  /** Axial force of the introducer's guide and sheath on the wire, with its sign reversed: negative where they push a
   *  bent wire out. Contained in bending, no part of the sum [N]. */
  double configurational = std::numeric_limits<double>::quiet_NaN();

  double sum() const { return bending + friction + inertia + drag + load + valve; }
};

/** State of one of several instruments on one centreline (concentric_stack.h). */
struct LayerState
{
  double inserted_length = 0.0;             ///< tip beyond the introducer; negative: outside [m]
  double rotation = 0.0;                    ///< rotation of the handle [rad]
  double speed = 0.0;                       ///< insertion speed in the last step [m/s]
  std::vector<double> twist_angle;          ///< material frame against Bishop frame [rad], n−1
  double friction_stretch = 0.0;            ///< elastic displacement in the next outer layer before sliding [m]
  double friction_turn = 0.0;               ///< mean angle to the next outer layer at which both stick [rad]
  double friction_share = 0.0;              ///< acting part of the friction torque with the next outer layer, −1 to 1
  std::vector<double> load;                 ///< normal load on the next outer layer [N/m], n
  std::vector<Eigen::Vector3d> bore_shift;  ///< shift of the layers inside the next outer one in its bore [m], n
  double force_offset = 0.0;                ///< part of hand_force since the last change of the reference; fades [N]
  double hand_force = 0.0;                  ///< axial force on the hand, positive when it pushes back [N]
  double hand_torque = 0.0;                 ///< torque that the hand holds [N·m]
};

/** State of the wire, which every step changes. Arrays run over all nodes (n) or edges (n−1) of the wire; nodes before
 *  first_node lie outside the introducer, straight and not simulated. */
struct State
{
  int first_node = 0;                        ///< first simulated node
  double inserted_length = 0.0;              ///< wire beyond the introducer [m]
  double rotation = 0.0;                     ///< rotation of the handle [rad]
  std::vector<Eigen::Vector3d> position;     ///< positions of the nodes [m], n
  std::vector<Eigen::Vector3d> velocity;     ///< velocities of the nodes [m/s], n
  std::vector<double> tension;               ///< multiplier of inextensibility [N], n−1
  std::vector<Eigen::Vector3d> moment;       ///< bending moment in space, in schemes that solve for it [N·m], n
  std::vector<double> twist_angle;           ///< material frame against Bishop frame [rad], n−1
  std::vector<Eigen::Vector3d> wall_force;   ///< normal force of the wall on each node [N], n
  std::vector<double> friction_coefficient;  ///< Coulomb coefficient of the contact at each node [1], n
  /** Elastic tangential displacement of the wall's friction, at most StepperSettings::friction_slip [m], n. */
  std::vector<Eigen::Vector3d> friction_stretch;
  /** Offset of the gaps of each node's contacts [m], n. It keeps the contact forces at a change of nodes, and fades.
   * NaN where the nodes have changed since the last step. */
  std::vector<double> wall_offset;
  /** Offset of each node's rest curvature binormal, in space [1], n. It keeps the moments at a change of nodes, and
   *  fades. */
  std::vector<Eigen::Vector3d> curvature_offset;
  double hand_force = 0.0;   ///< axial force of the wire on the hand, positive when it pushes back [N]
  double hand_torque = 0.0;  ///< torque that the hand holds about the wire's axis [N·m]

  HandForceParts hand_parts;  ///< parts of hand_force
  double valve_torque = 0.0;  ///< part of hand_torque that the introducer's valve holds [N·m]
  /** Elastic displacement of the valve's friction along and about the wire before sliding [m]. */
  Eigen::Vector2d valve_stretch = Eigen::Vector2d::Zero();

  /** Layers of a stack of instruments, from the inside out; empty for one wire. The members above then describe the
   *  reference, the layer that reaches furthest; hand_force and hand_torque are sums over all layers. */
  std::vector<LayerState> layers;
  int reference = 0;  ///< layer whose material the nodes follow

  EndMotion distal;            ///< motion of the held distal end since the start
  double tip_transport = 0.0;  ///< angle from the Bishop frame to a held tip's director, over full turns [rad]
  double distal_torque = 0.0;  ///< torque about the wire's axis on a clamp of the distal end's twist [N·m]
  Eigen::Vector3d distal_anchor = Eigen::Vector3d::Zero();   ///< position of the held distal end at the start [m]
  Eigen::Vector3d proximal_force = Eigen::Vector3d::Zero();  ///< force of the wire on the hold of its proximal end [N]
  Eigen::Vector3d distal_force = Eigen::Vector3d::Zero();    ///< force of the wire on the hold of its distal end [N]

  /** 64-bit hash over the positions and twist angles, of all layers, from first_node on, as IEEE-754 bytes. */
  std::uint64_t hash() const;
};

/** Position of the handle of one instrument, and its reaction. */
struct HandleState
{
  double inserted_length = 0.0;  ///< tip beyond the introducer; negative: outside [m]
  double rotation = 0.0;         ///< [rad]
  double force = 0.0;            ///< axial force on the hand, positive when it pushes back [N]
  double torque = 0.0;           ///< torque that the hand holds [N·m]
};

/** Handle of one of the instruments of a state. */
HandleState handleState(const State& state, int instrument);

/** Saves or loads all of a state. */
void archive(Archive& archive, State& state);

/** Checks a loaded state against its wire: lengths of the arrays, indices, and finite numbers.
 *  @param nodes number of nodes of the whole wire
 *  @param layers number of layers of a stack; 0 for one wire
 *  @throws ArchiveError when the state does not fit */
void requireFit(const State& state, int nodes, int layers);

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
