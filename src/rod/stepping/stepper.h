#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

#include "common/phase_timer.h"
#include "contact/contract/contact_set.h"
#include "contact/contract/wall_motion.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Hold of an end of the wire. */
enum class EndHold
{
  kFree,     ///< no force, no torque
  kPinned,   ///< position held, direction free
  kClamped,  ///< position and direction held: the clamp acts at the middle of the end edge
};

class SolutionObserver;

/** Holds of the wire: an introducer, or the holds of its two ends. */
struct Boundary
{
  /** True: the wire enters at `origin` along `direction`, its proximal part is pushed. False: the whole wire is there
   *  from the start. */
  bool introducer = true;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< mouth of the introducer, or the proximal end [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< initial direction of the wire, unit
  Eigen::Vector3d director = Eigen::Vector3d::UnitY();   ///< material direction d1 at rotation 0, unit, ⟂ direction
  double guide_length = 19e-3;                           ///< length of the introducer's guide before the mouth [m]
  /** Length over which a deflection of the wire decays inside the guide, at most a quarter of its length [m]. */
  double guide_decay = 3e-3;
  /** Radial clearance between wire and introducer sheath [m]. It is at most the clearance between wire and vessel at
   *  the mouth. */
  double sheath_clearance = std::numeric_limits<double>::infinity();
  EndHold proximal = EndHold::kFree;  ///< hold of the proximal end without an introducer; a clamp holds the twist too
  EndHold distal = EndHold::kFree;    ///< hold of the distal end
  bool distal_twist_held = false;     ///< true: a clamped distal end holds the twist too
};

/** Loads along the whole wire. Zero omits a term. */
struct Environment
{
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< acceleration; buoyancy is subtracted [m/s²]
  double fluid_density = 0.0;                         ///< density of the fluid, for drag and buoyancy [kg/m³]
  double drag_coefficient = 1.2;                      ///< drag coefficient of a cylinder across the stream [1]
  double damping = 0.0;                               ///< mass-proportional [1/s]
};

/** Solver of the linear systems of a step. */
enum class LinearSolver
{
  kBanded,  ///< banded LDLᵀ
  kSparse,  ///< SuiteSparse on the assembled matrix: general and slower, a check of the banded solver
};

/** Settings of the solver. */
struct StepperSettings
{
  LinearSolver linear_solver = LinearSolver::kBanded;
  int max_iterations = 8;          ///< linear solves in one step, truncated ones included
  double strain_tolerance = 5e-5;  ///< largest edge strain at which a step is accepted [1]
  /** `kkt`: largest edge strain that a second-order correction removes in place of another solve, relative to
   *  strain_tolerance; at most 1: no correction. A motion that leaves more strain is linearised again. */
  double corrected_strain_ratio = 4.0;
  double contact_stiffness = 1e5;       ///< penalty of a rigid wall per contact [N/m]
  double contact_margin = 0.25e-3;      ///< distance to the wall up to which contacts are detected [m]
  double penetration_tolerance = 3e-5;  ///< depth of a new contact beyond which the step is solved again [m]
  double max_rotation = 0.3;            ///< largest rotation of an edge in one solve [rad]
  /** `kkt`: the wall is curved between its contacts, which have one plane each. The system then contains the turn of
   * the normals with the motion of the nodes. Facets supply the curvature themselves. */
  bool curved_wall = false;
  double friction_slip = 0.5e-6;  ///< tangential displacement of a node at which it begins to slide [m]
};

/** A force on one node [N]. */
struct NodalForce
{
  int node = 0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  /** Instrument of a stack on which it acts, for the forces on the hands; −1: the one inserted furthest. */
  int layer = -1;
};

/** Drag of a stream on one node: force coefficient·(stream − v), v the velocity of the wire's surface there. */
struct NodalDrag
{
  int node = 0;
  Eigen::Matrix3d coefficient = Eigen::Matrix3d::Zero();  ///< symmetric, positive semidefinite [N·s/m]
  Eigen::Vector3d stream = Eigen::Vector3d::Zero();       ///< velocity of the fluid [m/s]

  /** Force on the node [N]. @param travel of the wire's surface in a step of @p dt [m] */
  Eigen::Vector3d force(const Eigen::Vector3d& travel, double dt) const { return coefficient * (stream - travel / dt); }
};

/** Position of the handle of one layer at the end of a step. */
struct LayerInput
{
  double inserted_length = 0.0;  ///< wire beyond the introducer; negative: outside [m]
  double rotation = 0.0;         ///< [rad]
  /** Bound of the force on the handle: the friction between layers yields where it would be exceeded [N]. */
  double most_force = std::numeric_limits<double>::infinity();
};

/** Input of one step. */
struct StepInput
{
  std::uint64_t step = 0;
  std::uint32_t substep = 0;
  std::uint64_t vessel_version = 0;  ///< version of the wall for contact detection; 0: any
  double inserted_length = 0.0;      ///< wire beyond the introducer at the end of the step [m]
  double rotation = 0.0;             ///< rotation of the handle at the end of the step [rad]
  std::vector<LayerInput> layers;    ///< handles of a stack, in place of the two above; empty for one wire
  EndMotion distal;                  ///< motion of a held distal end at the end of the step
  std::vector<NodalForce> forces;
  /** Of nodes in a stream, in ascending order; implicit in the velocities of the nodes. Requires
   *  SchemeTraits::streams. */
  std::vector<NodalDrag> drags;
  double tip_torque = 0.0;          ///< external torque at the tip [N·m]
  std::vector<double> edge_torque;  ///< external torque about the axis of every edge; empty: none [N·m]
  /** Motion of the wall in the step, by which the nodes are carried; null: the wall rests. Requires
   *  SchemeTraits::moving_walls. Nodes that are held must lie where the map is the identity. */
  contact::WallMotion* wall = nullptr;
  double wall_from = 0.0;  ///< share of the wall's motion at the beginning of this step
  double wall_to = 1.0;    ///< at its end

  /** Sets the position of every handle: one for a wire, several for a stack. */
  void setHandles(const std::vector<LayerInput>& handles);
};

/** Cost and result of one step. */
struct StepReport
{
  bool solved = true;           ///< false: no solution even at an eighth of the step; the state is unchanged
  int solves = 0;               ///< linear systems solved
  int factorisations = 0;       ///< active-set passes included
  int truncations = 0;          ///< solves truncated by the trust region
  int bisections = 0;           ///< bisections of the time step
  int hit_iteration_limit = 0;  ///< steps accepted at the limit of solves
  double max_strain = 0.0;      ///< largest edge strain after the step [1]
  /** First pass with a stale contact set, as all later ones of the step then are; kNoStalePass without. */
  std::uint32_t first_stale_pass = contact::kNoStalePass;

  void add(const StepReport& other);
};

/** Time integration scheme of the rod: one step. */
class Stepper
{
public:
  virtual ~Stepper() = default;

  /** A straight wire at rest along the boundary's direction. */
  virtual State initialState(double inserted_length, double rotation) const = 0;

  /** The same for all instruments.
   *  @throws std::invalid_argument when there is not one input for every instrument */
  virtual State initialState(const std::vector<LayerInput>& layers) const;

  /** Length of an instrument [m]. */
  virtual double layerLength(int /*layer*/) const { return discretisation().length(); }

  /** Advances the state by @p dt [s].
   *  @param pass counter of the contact passes of the caller's step, over its sub-steps
   *  @param contacts null without a vessel
   *  @throws std::invalid_argument for drags in schemes without SchemeTraits::streams, or at nodes that do not exist or
   *          do not ascend */
  virtual StepReport step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                          contact::ContactSource* contacts, PhaseTimer& timer) = 0;

  /** Elastic energies of a state. */
  virtual Energy energy(const State& state) = 0;

  /** Contact set of the state after the last step; empty without a vessel. */
  virtual const contact::ContactSet& contactSet() const = 0;

  /** Sets the least radius of the surface for contact at every node, until the nodes change; empty: the wire's own [m].
   *  Schemes without SchemeTraits::balloons ignore it. */
  virtual void setContactRadii(const std::vector<double>& radii);

  /** Invalidates the contact set, after the state was changed from outside. */
  virtual void invalidateContacts() = 0;

  virtual const Discretisation& discretisation() const = 0;

  /** Saves the data that the next step needs besides its state, or loads them into a stepper with the same nodes.
   *  @param state to which they belong
   *  @throws std::logic_error in schemes without SchemeTraits::saves */
  virtual void archive(Archive& archive, const State& state);

  /** Sets the observer of every step from now on; null: none. It must outlive the steps.
   *  @throws std::logic_error in schemes without SchemeTraits::observes */
  virtual void setObserver(SolutionObserver* observer);

  /** Takes over another sampling of the same wire; the caller resamples the state.
   *  @return false in schemes without SchemeTraits::adaptive */
  virtual bool resample(const Discretisation& rod);
};

inline void Stepper::setContactRadii(const std::vector<double>& /*radii*/) {}

inline void Stepper::archive(Archive& /*archive*/, const State& /*state*/)
{
  throw std::logic_error("Stepper: this scheme's state cannot be saved");
}

inline void Stepper::setObserver(SolutionObserver* /*observer*/)
{
  throw std::logic_error("Stepper: this scheme cannot be observed");
}

inline bool Stepper::resample(const Discretisation& /*rod*/)
{
  return false;
}

}  // namespace endovascular_sim::rod
