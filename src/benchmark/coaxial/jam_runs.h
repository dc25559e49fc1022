#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::benchmark
{

/** Path of a catheter. */
enum class JamPath
{
  kRightAngle,  ///< bend of 90°
  kHairpin,     ///< bend of 180°
  kS,           ///< two bends of 90° in opposite directions
};

/** Wire that is pushed through a catheter against a closed end, with bends of 30 mm radius. The tip of the wire, beyond
 *  the catheter, is too stiff to buckle. */
struct JamCase
{
  std::string name;
  double grip = 5.0;      ///< force limit of both hands [N]
  double friction = 0.3;  ///< between wire and catheter [1]
  JamPath path = JamPath::kRightAngle;
  double clearance = 4e-4;  ///< radius of the bore less that of the wire [m]
};

/** The cases of grips, frictions and paths. Each clearance occurs with every other value. */
std::vector<JamCase> jamCases();

/** Jam at one time. */
struct JamSample
{
  double tip_load = 0.0;                                 ///< of the stop on the wire beyond the catheter [N]
  double wire = 0.0;                                     ///< force of the wire on its hand [N]
  double catheter = 0.0;                                 ///< force of the catheter on its hand [N]
  double insertion = 0.0;                                ///< of the wire [m]
  double protrusion = 0.0;                               ///< of the wire beyond the catheter [m]
  Eigen::Vector3d end_force = Eigen::Vector3d::Zero();   ///< of stop and vessel on the wire beyond the catheter [N]
  Eigen::Vector3d end_moment = Eigen::Vector3d::Zero();  ///< of these forces about the tip of the catheter [N·m]
  std::vector<Eigen::Vector3d> axis;                     ///< centreline [m]
};

/** Largest values over a run. */
struct JamResult
{
  double hand_ratio = 0.0;   ///< force on a hand over its grip [1]
  double layer_force = 0.0;  ///< force on a layer over the sum of the grips [1]
  double imbalance = 0.0;    ///< sum over the hands less the force of the stack [N]
  double unexplained = 0.0;  ///< work that the energy audit does not explain over its turnover [1]
  int rejected = 0;          ///< steps
  JamSample pushed;          ///< largest force of the wire while it slides, before a hand slips
  JamSample jammed;          ///< at the end
};

JamResult runJam(const JamCase& at);

/** Run in a rigid tube. The friction of a wall uses the normal force of the last solution: with long steps the contacts
 *  chatter, and the force is too small. Under loads of a few newtons they do not with these. */
struct JamReference
{
  double step = 1e-4;    ///< [s]
  double edge = 1e-3;    ///< [m]
  double speed = 0.04;   ///< of the hand [m/s]
  double travel = 4e-3;  ///< of the tip, to the end of the catheter [m]
  double ramp = 2e-3;    ///< travel of the hand in which the load grows [m]
};

/** Force of the hand on the same wire in a rigid tube of the catheter's bore along a recorded axis, pushed slowly
 *  against the load of the sample on its tip [N]. Without friction it is that load. */
double forceInRigidTube(const JamCase& at, const JamSample& sample, const JamReference& reference);

/** Load of the wire beyond the catheter on the end of the rigid tube's wire. */
enum class JamMouth
{
  kFree,   ///< its part along the tube
  kLoaded  ///< the whole force, and its moment about the tip of the catheter
};

/** As forceInRigidTube(), by pushThroughBore(), against the forces on the wire beyond the catheter.
 *  @param spacing of the stations [m] */
double staticForceInRigidTube(const JamCase& at, const JamSample& sample, JamMouth mouth, double spacing = 5e-4);

}  // namespace endovascular_sim::benchmark
