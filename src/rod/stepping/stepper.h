#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

#include "common/phase_timer.h"
#include "contact/contract/contact_set.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** How an end of the wire is held when no introducer holds it. */
enum class EndHold
{
  kFree,
  kPinned,   ///< the end node is fixed
  kClamped,  ///< the two end nodes are fixed: the clamp acts at the middle of the end edge
};

/** What holds the wire. */
struct Boundary
{
  /** True: the wire enters at `origin` along `direction`, its proximal part is pushed; false: it is all there. */
  bool introducer = true;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< of the introducer, or the proximal end [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit
  Eigen::Vector3d director = Eigen::Vector3d::UnitY();   ///< material direction d1 at rotation 0, unit, ⟂ direction
  double guide_length = 19e-3;                           ///< over which the introducer's lateral guide fades [m]
  double guide_stiffness = 5300.0;                       ///< at the guide's outer end, per length of wire [N/m²]
  /** By which the wire's axis may leave the guide's, at most what the vessel leaves to it in the mouth [m]. */
  double sheath_clearance = std::numeric_limits<double>::infinity();
  EndHold proximal = EndHold::kFree;  ///< without an introducer; a clamp holds the twist too
  EndHold distal = EndHold::kFree;
  bool distal_twist_held = false;  ///< of a clamped distal end
};

/** What acts on the whole wire. Zero leaves the term out. */
struct Environment
{
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< buoyancy in the fluid is taken off [m/s²]
  double fluid_density = 0.0;                         ///< for drag and buoyancy [kg/m³]
  double drag_coefficient = 1.2;                      ///< of a cylinder
  double damping = 0.0;                               ///< mass-proportional [1/s]
};

/** What solves the linear systems of a step. */
enum class LinearSolver
{
  kBanded,  ///< the banded LDLᵀ
  kSparse,  ///< SuiteSparse on the assembled matrix: general, slower, the check of the banded one
};

struct StepperSettings
{
  LinearSolver linear_solver = LinearSolver::kBanded;
  int max_iterations = 12;         ///< linear solves in one step, truncated ones included
  double strain_tolerance = 5e-5;  ///< a step that leaves more is solved again
  /** `kkt`: a larger strain up to this is taken out by another right-hand side instead of another solve; 0: none. */
  double corrected_strain = 0.0;
  double contact_stiffness = 1e5;       ///< penalty of a rigid wall per contact [N/m]
  double contact_margin = 0.25e-3;      ///< features closer than this are listed [m]
  double penetration_tolerance = 3e-5;  ///< an unknown contact deeper than this is solved for again [m]
  double max_rotation = 0.3;            ///< of an edge in one solve [rad]
  double friction_slip = 0.5e-6;        ///< a node dragged further over the wall begins to slide [m]
};

/** A force on one node [N]. */
struct NodalForce
{
  int node = 0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

/** What drives one layer of a stack. */
struct LayerInput
{
  double inserted_length = 0.0;  ///< at the end of the step; negative: outside [m]
  double rotation = 0.0;         ///< at the end of the step [rad]
};

/** What drives one step. */
struct StepInput
{
  std::uint64_t step = 0;
  std::uint32_t substep = 0;
  std::uint64_t vessel_version = 0;  ///< that contact must be found with; 0: any
  double inserted_length = 0.0;      ///< at the end of the step [m]
  double rotation = 0.0;             ///< at the end of the step [rad]
  std::vector<LayerInput> layers;    ///< of a stack, in place of the two above; empty for one wire
  EndMotion distal;                  ///< of a held distal end, at the end of the step
  std::vector<NodalForce> forces;
  double tip_torque = 0.0;          ///< [N·m]
  std::vector<double> edge_torque;  ///< from outside about the axis of every edge; empty: none [N·m]
};

/** What one step took. */
struct StepReport
{
  bool solved = true;           ///< false: no solution even at an eighth of the step; the state stayed as it was
  int solves = 0;               ///< linear systems solved
  int factorisations = 0;       ///< active-set passes included
  int truncations = 0;          ///< solves cut short by the trust region
  int bisections = 0;           ///< of the time step
  int hit_iteration_limit = 0;  ///< steps accepted at the limit of solves
  double max_strain = 0.0;      ///< after the step
  /** First pass that used an old contact set, as all later ones of the step then do; kNoStalePass without. */
  std::uint32_t first_stale_pass = contact::kNoStalePass;

  void add(const StepReport& other);
};

/** One time step of the rod: the interface that all schemes share. */
class Stepper
{
public:
  virtual ~Stepper() = default;

  /** Puts a straight wire at rest along the boundary's direction. */
  virtual State initialState(double inserted_length, double rotation) const = 0;

  /** Advances the state by @p dt [s].
   *  @param pass counts the contact passes of the caller's step, over its sub-steps
   *  @param contacts null without a vessel */
  virtual StepReport step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                          contact::ContactSource* contacts, PhaseTimer& timer) = 0;

  /** Elastic energies of a state. */
  virtual Energy energy(const State& state) = 0;

  /** Contact set of the state that the last step left; empty without a vessel. */
  virtual const contact::ContactSet& contactSet() const = 0;

  /** Least radius of the surface at every node where it meets the wall, from now on until the nodes change; empty:
   *  the wire's own [m]. Only what the `kkt` scheme is made of heeds it. */
  virtual void setContactRadii(const std::vector<double>& radii);

  /** Forgets the contact set, after the state was changed from outside. */
  virtual void invalidateContacts() = 0;

  virtual const Discretisation& discretisation() const = 0;

  /** Saves what the next step needs besides its state, or loads it into a stepper with the same nodes.
   *  @param state that it belongs to
   *  @throws std::logic_error in schemes that do not know how: all but `kkt` */
  virtual void archive(Archive& archive, const State& state);

  /** Goes on with another sampling of the same wire; the state is carried over by the caller.
   *  @return false when the scheme keeps the nodes that it was made with */
  virtual bool resample(const Discretisation& rod);
};

inline void Stepper::setContactRadii(const std::vector<double>& /*radii*/) {}

inline void Stepper::archive(Archive& /*archive*/, const State& /*state*/)
{
  throw std::logic_error("Stepper: this scheme's state cannot be saved");
}

inline bool Stepper::resample(const Discretisation& /*rod*/)
{
  return false;
}

}  // namespace endovascular_sim::rod
