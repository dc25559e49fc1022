#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/twist/twist_friction.h"

namespace endovascular_sim::rod
{

/** Boundary conditions and external torques of the wire's twist. */
struct TwistBoundary
{
  bool held = true;                                     ///< false: the proximal end turns freely
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();   ///< tangent of the wire at the hold, unit
  Eigen::Vector3d director = Eigen::Vector3d::UnitY();  ///< d1 at the hold at rotation 0, unit, ⟂ tangent
  double position = 0.0;                                ///< arc length of the hold from the proximal end [m]
  double half_width = 0.0;                              ///< of the mouth of an introducer [m]; 0: the hold is a clamp
  double rotation = 0.0;                                ///< rotation of the handle [rad]
  double tip_torque = 0.0;                              ///< external torque at the tip about the axis [N·m]

  bool tip_held = false;                                    ///< true: the last edge's material frame is held too
  Eigen::Vector3d tip_director = Eigen::Vector3d::UnitY();  ///< d1 of the last edge at tip rotation 0, unit
  double tip_rotation = 0.0;                                ///< rotation of the tip's hold [rad]

  /** External torque about the axis of every edge [N·m], n−1; null or empty: none. */
  const std::vector<double>* edge_torque = nullptr;
  /** Friction of the wall by ascending nodes; null or empty: none. */
  const std::vector<TwistFriction>* friction = nullptr;

  bool hasMouth() const { return half_width > 0.0; }
  Mouth mouth() const { return {position, half_width}; }
  /** True where an external torque acts along the wire. */
  bool hasEdgeTorque() const { return edge_torque != nullptr && !edge_torque->empty(); }
  /** True where the wall's friction acts on the twist. */
  bool hasFriction() const { return friction != nullptr && !friction->empty(); }
  /** External torque on an edge [N·m]. */
  double edgeTorque(int edge) const { return hasEdgeTorque() ? (*edge_torque)[edge] : 0.0; }
};

/** Quasi-static twist (Bergou et al. 2008, §5.1): twist waves are far faster than bending, so the twist angles
 *  minimise the elastic energy for the present centreline.
 *
 *  The straight isotropic body carries one torque, a single unknown. Only the edges of the pre-curved tip, and all from
 *  the first node with friction on, have angles of their own. They are solved for by a damped tridiagonal Newton method
 *  that follows a snap-through to the next minimum. Friction, which is convex, gets secants where Newton's method does
 *  not converge. */
class QuasiStaticTwist
{
public:
  /** True when the twist acts on the wire: with rest curvature, a torque at the tip or along the wire, friction, or
   * both ends held. */
  static bool matters(const Discretisation& rod, const TwistBoundary& boundary);

  /** Transports the Bishop frame from the hold along the centreline, then solves for state.twist_angle,
   *  state.hand_torque and state.distal_torque. Edges before the hold turn with the handle. State::tip_transport counts
   *  the full turns of a held tip.
   *  @param same_centreline true: centreline, rod and hold are those of the last solve, whose frames are reused */
  void solve(const Discretisation& rod, const TwistBoundary& boundary, State& state, bool same_centreline = false);

  /** Computes torques and rest curvature for the angles of the state, without relaxing them: those of the straight body
   *  follow from that of its last edge. The torque of friction on edges before the hold is left out. */
  void evaluateAt(const Discretisation& rod, const TwistBoundary& boundary, State& state);

  /** Quadratic model of the energy, without friction, by the turns of the edges from firstUnknown() on. */
  struct Model
  {
    const std::vector<double>& gradient;  ///< [N·m]
    const std::vector<double>& diagonal;  ///< [N·m/rad]
    const std::vector<double>& upper;     ///< of an edge and the next one [N·m/rad]
  };

  /** Linearises at the angles of the last solve() or evaluateAt(). The least sufficient share of the concave part is
   *  omitted. */
  Model linearise(const Discretisation& rod, const TwistBoundary& boundary, const State& state);

  /** First edge with an angle of its own; n−1 without. */
  int firstUnknown() const { return first_own_ - 1; }

  /** Turns the edges from firstUnknown() on about their tangents, and updates the torques.
   *  @param share factor on the turns
   *  @param state after the motion: its centreline may differ from that of the last solution */
  void turn(const Discretisation& rod, const TwistBoundary& boundary, const std::vector<double>& turns, double share,
            State& state);

  /** First node at which rest curvature acts: on the curved tip, with a part of its cell beyond the hold. */
  int firstCurved() const { return first_curved_; }

  /** Rest curvature that acts at a curved node, in the material frame [1]. */
  const Eigen::Vector2d& restCurvature(const Discretisation& rod, int node) const
  {
    return isAtMouth(node) ? mouth_rest_[node - mouth_begin_].curvature : rod.rest_curvature[node];
  }

  /** Derivative of the bending energy by the arc length of the hold, at fixed positions and angles [N]. Beyond the
   *  mouth the wire bends from its rest curvature κ̄. Before it, the wire is held straight and has the energy ½ EI |κ̄|²
   *  per length. With the acting share a and the moment M, interpolated by the nodes' hat functions, the force is
   *  ∫ (½ EI |κ̄|² + κ̄·M) a′ ds. */
  double holdForce(const Discretisation& rod, const State& state) const;

  /** Rest curvature binormal at a node of the curved tip, in space: mean over both edges of ω̄₁m₂ − ω̄₂m₁, with the rest
   *  curvature that acts [1]. */
  const Eigen::Vector3d& restCurvatureBinormal(int node) const { return rest_binormal_[node]; }

  /** Part of restCurvatureBinormal() in the material frame of one of the node's two edges [1]; zero on an edge before
   *  the hold. */
  Eigen::Vector3d restCurvatureOnEdge(const Discretisation& rod, int node, int edge) const;

  /** Rest curvature binormals of all nodes from firstCurved() on [1]. */
  const std::vector<Eigen::Vector3d>& restCurvatureBinormals() const { return rest_binormal_; }

  /** Rest curvature binormal, in space, of another rest curvature at a node of the curved tip, in the unit of
   *  @p rest_curvature, for a cell that is wholly beyond the hold. */
  Eigen::Vector3d binormalOf(const Eigen::Vector2d& rest_curvature, int node,
                             const std::vector<double>& twist_angle) const;

  /** Torques at all nodes [N·m]. */
  const std::vector<double>& torques() const { return torque_; }

  /** Torque at a node [N·m]: GJ·2m/l̄. */
  double torque(int node) const { return torque_[node]; }

  /** Energy of the twist alone, GJ m²/l̄ summed [J]; of the state last solved. */
  double energy() const { return energy_; }

private:
  void prepare(const Discretisation& rod, const TwistBoundary& boundary, State& state, bool same_centreline);
  void followFrames(const Discretisation& rod, const TwistBoundary& boundary, State& state);
  void transportBishopFrame(const Discretisation& rod, const TwistBoundary& boundary, const State& state);
  void relax(const Discretisation& rod, const TwistBoundary& boundary, State& state);
  void placeTip(const Discretisation& rod, const TwistBoundary& boundary, State& state) const;
  double assemble(const Discretisation& rod, const TwistBoundary& boundary, const State& state, bool secants);
  void turnFrames(const TwistBoundary& boundary, const State& state);
  Eigen::Vector3d binormalOnEdge(const Eigen::Vector2d& rest_curvature, int edge, double cosine, double sine) const;
  bool isAtMouth(int node) const
  {
    return node >= mouth_begin_ && node < mouth_begin_ + static_cast<int>(mouth_rest_.size());
  }
  double edgeAngle(const TwistBoundary& boundary, const State& state, int edge) const
  {
    return edge < first_edge_ ? boundary.rotation : state.twist_angle[edge];
  }
  Eigen::Vector3d edgeTangent(int edge) const { return bishop_[edge].cross(bishop_normal_[edge]); }
  void prepareMouth(const Discretisation& rod, const TwistBoundary& boundary);
  void addRestCurvature(const Discretisation& rod, int node);
  void addFriction(const TwistBoundary& boundary, const State& state, bool secants);
  double balanced(const TwistBoundary& boundary) const;
  double solveForStep(int first, int last, double omitted);
  void evaluate(const Discretisation& rod, const TwistBoundary& boundary, State& state);
  void evaluateBody(const Discretisation& rod, const TwistBoundary& boundary, State& state);
  void evaluateTip(const Discretisation& rod, const TwistBoundary& boundary, State& state);
  void prepareBody(const Discretisation& rod, const TwistBoundary& boundary);
  double bodyTorque(const TwistBoundary& boundary, double angle) const;

  int first_edge_ = 0;                   ///< first edge beyond the hold
  int first_curved_ = 0;                 ///< first curved node with a part of its cell beyond the hold; n without
  int first_own_ = 0;                    ///< first node with angles of their own on both sides; n without
  int mouth_begin_ = 0;                  ///< first node with rest curvature at the mouth
  std::vector<RestAtMouth> mouth_rest_;  ///< of the nodes from there on that the mouth touches
  double straight_force_ = 0.0;          ///< part of holdForce() of the straight energy [N]
  int last_body_ = 0;                    ///< last edge of the straight body
  double body_stiffness_ = 0.0;
  double body_load_ = 0.0;        ///< external torque on the body before its last edge [N·m]
  double body_load_angle_ = 0.0;  ///< rotation of the body's last edge by that torque [rad]
  double held_friction_ = 0.0;    ///< torque of friction on edges that turn with the handle [N·m]
  double held_rest_ = 0.0;        ///< torque of rest curvature on them [N·m]
  double tip_gradient_ = 0.0;     ///< gradient of the potential energy by the last edge's angle [N·m]
  double energy_ = 0.0;
  std::vector<Eigen::Vector3d> bishop_;                                ///< first Bishop director per edge
  std::vector<Eigen::Vector3d> bishop_normal_;                         ///< second one, tangent × first
  Eigen::Vector3d tip_bishop_, tip_normal_;                            ///< both directors of the last edge
  std::vector<Eigen::Vector3d> bishop_before_, bishop_normal_before_;  ///< both on the last centreline
  std::vector<Eigen::Vector3d> binormal_;                              ///< κb per curved node
  std::vector<double> cosine_, sine_;  ///< cosine and sine of the twist angles of the curved tip's edges
  std::vector<Eigen::Vector3d> rest_binormal_;
  std::vector<double> torque_;
  std::vector<double> gradient_, diagonal_, upper_, concave_;
  std::vector<double> pivot_, step_;
};

}  // namespace endovascular_sim::rod
