#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/hash.h"
#include "common/phase_timer.h"
#include "contact/contract/contact_set.h"
#include "contact/rollers.h"
#include "drive/grip_search.h"
#include "rod/boundary/hemostatic_valve.h"
#include "rod/sampling/adaptive_sampling.h"
#include "rod/stepping/stepper.h"
#include "scene/model/scene.h"
#include "scene/scene_vessel.h"
#include "simulation/balloon_treatments.h"
#include "simulation/blood_coupling.h"
#include "simulation/contrast_injections.h"
#include "simulation/handle.h"
#include "simulation/motion_coupling.h"

namespace endovascular_sim::simulation
{

/** Commands of the scene's drives for all instruments at a time [s]. */
std::vector<drive::HandCommand> commandsAt(const scene::Scene& scene, double time);

/** Simulation of a scene in fixed time steps. The nodes and the offline tool run this same code, so that the same
 *  commands give the same trajectory bit for bit. */
class Simulation
{
public:
  /** @param contacts source of contact sets, null without a vessel; must outlive the simulation. Those of a scene's
   *         rollers come from the simulation itself
   *  @param centreline of the vessel, whose curvature adaptive sampling uses ahead of the tip; may be null
   *  @param wall that balloons deform, e.g. a LocalDeformableWall; null: a rigid wall. Must outlive the simulation
   *  @throws InputError when the scene's wire, sampling or scheme cannot be simulated */
  Simulation(const scene::Scene& scene, const scene::EntryPose& entry, contact::ContactSource* contacts,
             const vessel::CentrelineTree* centreline = nullptr, intervention::DeformableWall* wall = nullptr);

  /** Advances by one time step. The hand slips or stops (DriveScene::grip) where the wire resists with more than the
   *  scene's limits, and moves at most at drive.limits.speed: the rest of a faster command follows in the next steps.
   */
  void step(const drive::HandCommand& command) { stepAll({command}); }

  /** Advances by one time step with one command for every instrument of the scene, in its order. The insertion of an
   *  instrument is limited by its length and by the introducer, where it waits while an instrument that does not fit is
   *  inside.
   *  @throws std::invalid_argument when there is not one command for every instrument, or a pressure for one without a
   *          balloon */
  void stepAll(const std::vector<drive::HandCommand>& commands);

  /** Number of the scene's instruments. */
  int instruments() const { return static_cast<int>(hands_.size()); }

  /** Handle of an instrument. */
  HandState hand(int instrument) const;

  /** Position that an instrument has reached, in the scale of its commands: its position plus the slipped motion. The
   *  difference from the last command is the motion that is still to follow. */
  drive::HandMotion reached(int instrument) const;

  /** Slipped motion of an instrument's handle: the scale of its commands minus its position. */
  drive::HandMotion slipped(int instrument) const;

  /** Positions between the present stops of an instrument, in the scale of its commands [m]: the introducer, the end of
   *  the instrument, and an instrument inside that it does not fit. Unbounded without an introducer. */
  drive::Interval stops(int instrument) const;

  /** True where an instrument has left the introducer altogether, so that others need not fit into it. */
  bool isOutside(int instrument) const;

  /** Replaces the state by one of the same wire and sampling; contacts are detected again. */
  void setState(rod::State state);

  /** Saves all data on which the further trajectory depends.
   *  @param vessel_hash of the mesh at the start; 0 without a vessel
   *  @param more archives the caller's own data after those of the simulation
   *  @throws InputError for a scheme without SchemeTraits::saves */
  void save(std::ostream& stream, std::uint64_t vessel_hash = 0, const std::function<void(Archive&)>& more = nullptr);

  /** Continues from a saved state, bit for bit as the simulation that was saved. The present state, whatever it is, is
   *  replaced. Sums over past steps (forces on the wall, results) start at zero.
   *  @param origin names the stream in errors
   *  @throws InputError when the state is damaged or belongs to another version, scene or vessel; the simulation then
   *          needs another load before its next step */
  void load(std::istream& stream, std::uint64_t vessel_hash = 0, const std::string& origin = "state",
            const std::function<void(Archive&)>& more = nullptr);

  /** Takes over the state of a scene with other parameters, e.g. friction, stiffness or limits, but the same
   *  instruments, nodes and vessel: shape, motion, handles, balloons and number of steps. Contacts are detected and
   *  solved anew. The caller's own data are skipped.
   *  @return true if the state holds data of its caller
   *  @throws InputError when the state is damaged, or belongs to another version, vessel, wire or sampling; the
   *          simulation then needs a load before its next step */
  bool adopt(std::istream& stream, std::uint64_t vessel_hash = 0, const std::string& origin = "state");

  /** Sets the observer of every step from now on, e.g. a rod::EnergyAudit; null: none. The trajectory does not change.
   *  @param observer must outlive the steps
   *  @throws std::logic_error for a scheme without SchemeTraits::observes */
  void setObserver(rod::SolutionObserver* observer);

  /** Pose of the introducer, or of the proximal end without one. */
  const scene::EntryPose& entry() const { return entry_; }

  /** True for a wire behind an introducer; false for one that is simulated as a whole. */
  bool hasIntroducer() const { return scene_.introducer; }

  /** Couples the simulation with the flow of blood; before the first step.
   *  @param wall vertices of the wall in which contact is detected; called at steps of the flow */
  void setBlood(std::unique_ptr<BloodCoupling> blood, std::function<const std::vector<Eigen::Vector3d>&()> wall);

  /** Coupling with the flow of blood; null in a scene without the key `flow`. @{ */
  const BloodCoupling* blood() const { return blood_.get(); }
  BloodCoupling* blood() { return blood_.get(); }
  /** @} */

  /** Reason for which an injection of contrast medium cannot begin now, with its remedy; empty without one.
   *  @param refill the syringe is filled before */
  std::string refusalOf(const contrast::Injection& injection, bool refill = false) const;

  /** Begins an injection with the next step of the flow.
   *  @throws std::logic_error without the key `contrast` of the scene, or without flow
   *  @throws std::invalid_argument where refusalOf() names a reason; nothing changes */
  void inject(const contrast::Injection& injection, bool refill = false);

  /** Ends the present injection; the rest stays in the syringe. @throws std::logic_error as inject() */
  void stopInjection();

  /** Ends the present injection, and fills the syringe. @throws std::logic_error as inject() */
  void refillSyringe();

  /** Contrast medium in syringe and instruments; null in a scene without the key `contrast`. That in the vessel is in
   *  the field of blood(). */
  const ContrastInjections* contrast() const { return contrast_ ? &*contrast_ : nullptr; }

  /** Moves the patient from now on; once, before the first step.
   *  @throws std::logic_error for a scheme without SchemeTraits::moving_walls, or a second call */
  void setMotion(const PatientMotion& motion);

  /** Motion of the patient; null in a scene without the key `motion`. @{ */
  const MotionCoupling* motion() const { return motion_.get(); }
  MotionCoupling* motion() { return motion_.get(); }
  /** @} */

  /** Place at rest of a point of the moved patient: where it lies in the vessel of the scene [m]. */
  Eigen::Vector3d atRest(const Eigen::Vector3d& point) const
  {
    return motion_ ? motion_->patient().map().pullBack(point) : point;
  }

  /** Places at rest of all nodes; their positions in a patient who does not move. Valid until the next change. */
  const std::vector<Eigen::Vector3d>& positionsAtRest() const;

  /** Stops adaptive sampling: the nodes keep their positions along the wire. */
  void keepSampling() { samples_ = false; }

  std::uint64_t steps() const { return steps_; }                                         ///< number of steps so far
  double time() const { return static_cast<double>(steps_) * scene_.solver.time_step; }  ///< [s]
  const rod::State& state() const { return state_; }
  const rod::Discretisation& discretisation() const { return stepper_->discretisation(); }
  const contact::ContactSet& contactSet() const { return stepper_->contactSet(); }
  const rod::StepReport& report() const { return report_; }  ///< report of the last step
  const PhaseTimer& timer() const { return timer_; }         ///< durations of the last step
  rod::Energy energy() const { return stepper_->energy(state_); }

  /** Depth of the wire's surface beyond the wall after the last step, by the contact set; 0 without contact [m]. */
  double surfacePenetration() const;

  /** Events of balloons and stents so far. */
  const std::vector<TimedEvent>& events() const { return treatments_.events(); }

  /** Rollers at their positions after the last step; null without. */
  const contact::Rollers* rollers() const { return rollers_.get(); }

  /** Balloon of an instrument, with its stent; null without. */
  const intervention::Treatment* treatment(int instrument) const { return treatments_.of(instrument); }

  std::uint64_t stateHash() const { return state_hash_; }  ///< hash of the state after the last step

  /** Contact query of the initial state, to check that the contact source answers. */
  contact::Query initialQuery() const;

  /** Hash over the states of all steps so far. */
  std::uint64_t trajectoryHash() const { return trajectory_.value(); }

private:
  void setMaxInsertions();
  rod::State initialState() const;
  double outsideInsertion() const;
  void archive(Archive& archive);
  void read(std::istream& stream, std::uint64_t vessel_hash, const std::string& origin, bool of_same_scene,
            const std::function<void(Archive&)>& more);
  void requireFit() const;
  void setPressures(const std::vector<drive::HandCommand>& commands);
  drive::HandIncrement wantedMotion(int instrument, const drive::HandCommand& command);
  HandleRange range(int instrument) const;
  double leastInsertion(int instrument) const;
  double mostInsertion(int instrument) const;
  int substepsFor(const std::vector<drive::HandIncrement>& wanted, const rod::EndMotion& from,
                  const rod::EndMotion& to) const;
  void setHandles(const std::vector<drive::HandIncrement>& parts, bool stale, double dt, rod::StepInput& input);
  void applyLoads(rod::StepInput& input) const;
  rod::EndMotion distalMotionAt(double t) const;
  double travelOfRollers() const;
  double workOfRollers(const std::vector<contact::Roller>& before) const;
  bool placeRollers(double time);
  void resample();
  std::uint64_t beginTreatments();
  void endTreatments();
  void exchangeBlood(std::uint64_t vessel_version);
  std::vector<double> insertions() const;
  void follow(const contrast::Injection& injection, bool refill);
  void beginMotion();
  void carry(double from, double to);
  void setWall(int substep, int substeps, rod::StepInput& input);
  void prepareContactRadii();
  void moveWire(const rod::StepInput& input, double dt, std::uint32_t& pass);
  void moveWithinGrips(rod::StepInput& input, double dt, std::uint32_t& pass);
  bool isBeyondGrip(const rod::State& state) const;
  void rest(const rod::StepInput& input);
  drive::GripSearch gripSearch() const;

  scene::Scene scene_;
  scene::EntryPose entry_;
  Eigen::Vector3d distal_direction_;           ///< direction of the distal end's displacement, unit
  std::unique_ptr<contact::Rollers> rollers_;  ///< null without rollers
  contact::ContactSource* contacts_;
  std::unique_ptr<rod::AdaptiveSampling> sampling_;  ///< null: uniform
  bool samples_ = false;                             ///< the nodes follow the sampling
  std::uint64_t sampling_every_ = 1;                 ///< steps between two updates of the sampling
  rod::Discretisation initial_nodes_;                ///< nodes of a new stepper
  std::unique_ptr<rod::Stepper> stepper_;
  rod::State state_;
  rod::StepReport report_;
  std::vector<Handle> hands_;           ///< one per instrument
  std::vector<double> max_insertions_;  ///< at which the introducer's guide is still filled [m]
  std::vector<drive::HandIncrement> wanted_, parts_;
  rod::State before_;                     ///< state before the present sub-step
  std::vector<rod::LayerInput> handles_;  ///< of the present sub-step, one per instrument
  std::vector<double> hand_forces_, hand_positions_;
  rod::HemostaticValve valve_;
  BalloonTreatments treatments_;
  std::unique_ptr<BloodCoupling> blood_;  ///< null: blood does not flow
  std::function<const std::vector<Eigen::Vector3d>&()> wall_;
  std::optional<ContrastInjections> contrast_;              ///< empty: no contrast medium is injected
  std::unique_ptr<MotionCoupling> motion_;                  ///< null: the patient rests
  mutable std::vector<Eigen::Vector3d> positions_at_rest_;  ///< empty: not known
  std::vector<double> pressures_;                           ///< commanded pressure of every instrument [Pa]
  PhaseTimer timer_;
  Hash64 trajectory_;
  std::uint64_t state_hash_ = 0;
  std::uint64_t steps_ = 0;
  rod::SolutionObserver* observer_ = nullptr;
  double max_travel_ = 0.0;  ///< largest travel of a handle in one sub-step [m]
};

}  // namespace endovascular_sim::simulation
