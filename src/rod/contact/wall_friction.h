#pragma once

#include <vector>

#include <Eigen/Core>

#include "contact/contract/wall_motion.h"
#include "rod/friction/coulomb_law.h"
#include "rod/model/state.h"
#include "rod/twist/twist_friction.h"

namespace endovascular_sim::rod
{

/** Motion of the wire's surface over the wall besides the motion of the nodes. The surface turns about the wire's axis,
 *  and that of a layer slides over the nodes (concentric_stack.h). */
struct SurfaceMotion
{
  const std::vector<double>& radius;                    ///< radius at every node [m], n
  const std::vector<double>& begin_angle;               ///< angle of every node at the beginning of the step [rad], n
  const std::vector<double>& angle;                     ///< angle of every node at the present iterate [rad], n
  const std::vector<Eigen::Vector3d>* slide = nullptr;  ///< slide over every node in the step [m], n; null: none
  const contact::WallTravel* wall = nullptr;            ///< motion of the wall at every node, n; null: it rests
  /** Turn of the wall about the wire's axis at every node, relative to the frames of the angles [rad], n. */
  const std::vector<double>* wall_turn = nullptr;
};

/** Twist angle of a node: the mean over its edges [rad]. */
double nodeAngle(const std::vector<double>& twist_angle, int node, int first_node);

/** Coulomb friction of the wall on the nodes, with sticking (docs/CONTACT.md).
 *
 *  Every node in contact stores its stretch u (State::friction_stretch): the tangential distance that its surface was
 *  dragged over the wall without sliding, |u| ≤ δ. The wall pulls with μ f_n u/δ while |u| ≤ δ, and with μ f_n u/|u|
 *  beyond: the node slides, and its stretch is cut to δ at the end of the step (return mapping). During a step, the
 *  stretch is u plus the tangential motion since the step began. The normal force f_n is that of the last solve.
 *
 *  Where the wall moves, tangential motion and turn are those relative to it (SurfaceMotion::wall).
 *
 *  With a SurfaceMotion, the motion is that of the surface: a turn Δθ about the tangent t adds r Δθ n × t, n the wall's
 *  normal. begin_angle follows the turn of the Bishop frame in space where a curved tip
 *  swings (FrameTurns); elsewhere it is neglected. Positions are solved for at a fixed turn, and the twist
 *  at a fixed motion (aboutAxis), both with the same potential.
 *
 *  A solve uses the secant stiffness μ f_n/max(|u|, δ) of the expected stretch. Along the direction of sliding, the
 *  node's inertia m/Δt² about that stretch is subtracted. Newton's tangent is zero there, and where inertia outweighs
 *  friction, a secant would brake an accelerating node. If a pass shows that friction deviates from Coulomb's law, the
 *  nodes concerned are linearised at its motion and the system is solved again.
 *
 *  Where positions and turns are unknowns of one system, the linearisation is that of the primal-dual Newton method
 *  (Chan, Golub & Mulet 1999, SIAM J. Sci. Comput. 20:1964) on F max(|u|, δ) = μ f_n u, with the force F of the
 *  preceding pass: the tangent where F and u agree, a secant where they do not, positive semidefinite always. */
class WallFriction
{
public:
  using Motion = std::vector<Eigen::Vector3d>;  ///< a solve's increment of every node [m]

  /** Friction on a node in one solve: gradient and Hessian of its potential with respect to the node's position. */
  struct Term
  {
    int node = 0;
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();       ///< minus the force at the present position [N]
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< [N/m], positive semidefinite
    Eigen::Vector3d around = Eigen::Vector3d::Zero();     ///< motion of the surface per turn of the node [m/rad]
    Eigen::Vector3d turned = Eigen::Vector3d::Zero();     ///< motion of the surface by the turn of the solve [m]

    /** Minus the force after a motion of the node and the turn of the solve [N]. */
    Eigen::Vector3d pullAfter(const Eigen::Vector3d& motion) const { return pull + stiffness * (motion + turned); }
  };

  /** @param slip δ, the stretch at which a node begins to slide [m] */
  explicit WallFriction(double slip) : slip_(slip) {}

  /** Collects the nodes in contact at the beginning of a solve.
   *  @param begin positions at the beginning of the step [m]
   *  @param mass mass of every node [kg]; null: secants only
   *  @param first_solve the expected stretch follows from the velocities; otherwise from the motion so far
   *  @param surface null: the surface follows the nodes. Its present angles need not be known yet */
  void collect(const State& state, const Motion& begin, const std::vector<double>* mass, double dt, bool first_solve,
               const SurfaceMotion* surface = nullptr);

  /** Friction about the axis at the expected motion, by ascending nodes; after collect() with a surface motion. */
  const std::vector<TwistFriction>& aboutAxis();
  /** Result of the last aboutAxis(). */
  const std::vector<TwistFriction>& lastAboutAxis() const { return about_axis_; }

  /** Linearises the collected nodes for the first pass of a solve.
   *  @param surface that of collect(), with its present angles */
  void linearise(const SurfaceMotion* surface = nullptr);

  /** Linearises the collected nodes for the first pass of a solve whose unknowns include the turns of the nodes.
   *  @param surface that of collect(), with its present angles */
  void lineariseWithTurns(const SurfaceMotion& surface);

  /** Linearises again, after a pass of such a solve, the nodes whose friction deviates from Coulomb's law.
   *  @param turn of every node in the solve [rad]
   *  @return true if a node was linearised again */
  bool updateWithTurns(const Motion& motion, const std::vector<double>& turn, int pass);

  std::size_t count() const { return terms_.size(); }
  const Term& term(std::size_t index) const { return terms_[index]; }

  /** Linearises again, after a pass, the nodes whose friction deviates from Coulomb's law by more than 1 % of their
   *  limit. It does nothing while all deviations together are below 10 % of all limits.
   *  @return true if a node was linearised again */
  bool update(const Motion& motion, int pass);
  /** Lowest node linearised by the last update that returned true; INT_MAX if none. */
  int firstChanged() const { return first_changed_; }

  /** Return mapping at the end of a step. The stretch of a node without wall force becomes zero.
   *  @param begin positions at the beginning of the step [m]
   *  @param surface that of collect(), with its present angles */
  void finish(State& state, const Motion& begin, const SurfaceMotion* surface = nullptr) const;

private:
  /** Friction data of a node in a solve. */
  struct Contact
  {
    int node = 0;
    double inertia = 0.0;                               ///< m/Δt² [N/m]
    double limit = 0.0;                                 ///< μ f_n [N]
    double begin_angle = 0.0;                           ///< angle at the beginning of the step [rad]
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();   ///< unit normal of the wall
    Eigen::Vector3d stretch = Eigen::Vector3d::Zero();  ///< stretch at the present iterate [m]
    Eigen::Vector3d guess = Eigen::Vector3d::Zero();    ///< expected stretch [m]
    Eigen::Vector3d around = Eigen::Vector3d::Zero();   ///< motion of the surface per turn [m/rad]
    Eigen::Vector3d dual = Eigen::Vector3d::Zero();     ///< pull of the preceding pass by the limit, at most 1
  };

  Eigen::Vector3d beginTerm(std::size_t index, const SurfaceMotion* surface);
  void linearise(std::size_t index, const Eigen::Vector3d& stretch, double inertia_weight);
  void lineariseAtDual(std::size_t index, const Eigen::Vector3d& stretch);
  Eigen::Vector3d force(std::size_t index, const Eigen::Vector3d& stretch) const;
  CoulombLaw law(const Contact& contact) const { return {contact.limit, slip_}; }

  double slip_;
  int first_changed_ = 0;
  std::vector<Contact> contacts_;
  std::vector<Term> terms_;
  std::vector<TwistFriction> about_axis_;
};

/** Friction force of the wall on a node after a step [N]; zero without a wall force.
 *  @param slip stretch at which a node begins to slide [m] */
Eigen::Vector3d frictionForce(const State& state, int node, double slip);

}  // namespace endovascular_sim::rod
