#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/model/state.h"
#include "rod/twist/twist_friction.h"

namespace endovascular_sim::rod
{

/** What drags the wire's surface over the wall beside the nodes' motion: it turns about the wire's axis, and that of a
 *  layer slides over the nodes (concentric_stack.h). */
struct SurfaceMotion
{
  const std::vector<double>& radius;                    ///< of every node [m], n
  const std::vector<double>& begin_angle;               ///< of every node at the beginning of the step [rad], n
  const std::vector<double>& angle;                     ///< at the present iterate [rad], n
  const std::vector<Eigen::Vector3d>* slide = nullptr;  ///< over every node in the step [m], n; null: none
};

/** Twist angle of a node, the mean of its edges' [rad]. */
double nodeAngle(const std::vector<double>& twist_angle, int node, int first_node);

/** Coulomb friction of the wall on the nodes, which sticks (docs/CONTACT.md).
 *
 *  Every node that touches keeps how far its surface has been dragged over the wall without sliding: its stretch u,
 *  tangential and at most δ long, in State::friction_stretch. The wall pulls with μ f_n u/δ; what is dragged further
 *  slides, pulled with μ f_n u/|u|, and its stretch is cut to δ at the end of the step (return mapping). Over a step
 *  the stretch is u + the tangential motion since the step began, and the normal force that of the last solve.
 *
 *  Where a scheme tells the wire's SurfaceMotion, that motion is the surface's: a turn Δθ about the tangent t adds
 *  r Δθ n × t, n the wall's normal. What the Bishop frame itself turns in space is left out. Positions are solved for
 *  at a known turn, the twist at a known motion (aboutAxis), both against the same potential.
 *
 *  A solve gets the secant μ f_n/max(|u|, δ) of the stretch to be expected. Along the direction of sliding it is
 * lowered by the node's inertia m/Δt² about that stretch: Newton's tangent there is zero, and where inertia outweighs
 * friction a secant would brake whatever gets faster. Where a pass shows friction to be far from Coulomb's law, the
 * nodes concerned are linearised again at its motion and the system is solved once more. */
class WallFriction
{
public:
  using Motion = std::vector<Eigen::Vector3d>;  ///< a solve's increment of every node [m]

  /** Friction on a node for one solve: gradient and second derivative of its potential by the node's position. */
  struct Term
  {
    int node = 0;
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();       ///< minus the force on the node where it is now [N]
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< [N/m], positive semidefinite
  };

  /** @param slip δ, the stretch at which a node begins to slide [m] */
  explicit WallFriction(double slip) : slip_(slip) {}

  /** Takes up what touches at the beginning of a solve.
   *  @param begin positions at the beginning of the step [m]
   *  @param mass of every node [kg]; null: secants only
   *  @param first_solve the velocities tell how far the nodes will go; else the motion so far does
   *  @param surface null: it follows the nodes. Its present angles need not be known yet */
  void collect(const State& state, const Motion& begin, const std::vector<double>* mass, double dt, bool first_solve,
               const SurfaceMotion* surface = nullptr);

  /** Friction about the axis, by ascending nodes, at the motion to be expected; after collect() with a surface's
   *  motion. */
  const std::vector<TwistFriction>& aboutAxis();
  /** What that gave last. */
  const std::vector<TwistFriction>& lastAboutAxis() const { return about_axis_; }

  /** Linearises what was collected for the first pass of a solve.
   *  @param surface as it was collected, with its present angles */
  void linearise(const SurfaceMotion* surface = nullptr);

  std::size_t count() const { return terms_.size(); }
  const Term& term(std::size_t index) const { return terms_[index]; }

  /** After a pass: takes nodes anew whose friction was not Coulomb's, when it matters.
   *  @return true when something changed */
  bool update(const Motion& motion, int pass);
  /** Lowest node of those that the last such update took anew; beyond all nodes where it took none. */
  int firstChanged() const { return first_changed_; }

  /** Return mapping at the end of a step. A node that nothing pushes on forgets its stretch.
   *  @param begin positions at the beginning of the step [m]
   *  @param surface as it was collected, with its present angles */
  void finish(State& state, const Motion& begin, const SurfaceMotion* surface = nullptr) const;

private:
  /** What a node's friction depends on during a solve. */
  struct Contact
  {
    int node = 0;
    double inertia = 0.0;                               ///< m/Δt² [N/m]
    double limit = 0.0;                                 ///< μ f_n [N]
    double begin_angle = 0.0;                           ///< of the node [rad]
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();   ///< of the wall, unit
    Eigen::Vector3d stretch = Eigen::Vector3d::Zero();  ///< at the present iterate [m]
    Eigen::Vector3d guess = Eigen::Vector3d::Zero();    ///< stretch to be expected [m]
    Eigen::Vector3d around = Eigen::Vector3d::Zero();   ///< motion of the surface per turn [m/rad]
  };

  void linearise(std::size_t index, const Eigen::Vector3d& stretch, double inertia_weight);
  Eigen::Vector3d force(std::size_t index, const Eigen::Vector3d& stretch) const;

  double slip_;
  int first_changed_ = 0;
  std::vector<Contact> contacts_;
  std::vector<Term> terms_;
  std::vector<TwistFriction> about_axis_;
};

/** Friction force of the wall on a node after a step [N]; zero where nothing pushes on it.
 *  @param slip as in WallFriction */
Eigen::Vector3d frictionForce(const State& state, int node, double slip);

}  // namespace endovascular_sim::rod
