#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/progress.h"
#include "contact/contract/contact_set.h"
#include "contrast/injection/injection.h"
#include "drive/hand_control.h"
#include "flow/coupling/flow_source.h"
#include "fluoroscopy/fluoroscope.h"
#include "geometry/triangle_mesh.h"
#include "intervention/deformable_wall.h"
#include "procedure/operator.h"
#include "procedure/perturbation.h"
#include "robot/command_faults.h"
#include "session/observation.h"
#include "session/run_record.h"
#include "session/world.h"
#include "simulation/driven_hands.h"
#include "simulation/simulation.h"

namespace endovascular_sim::session
{

/** Settings of a session beside its scene. */
struct SessionSettings
{
  bool results = false;  ///< true: gathers the results that finish() writes
  /** Simulated time between two searches for nodes outside the wall, for the results; 0: at the rate of
   *  `record.trajectory_rate` [s]. */
  double outside_check = 0.0;
  /** True: instruments with drive.source topic or device follow Session::control(). False: they follow their profiles.
   */
  bool clients = false;
  procedure::Spread spread;  ///< of the starts of Session::reset(seed)
  /** Source of contact sets in place of a detector of the world's wall; null: the detector. */
  std::shared_ptr<contact::ContactSource> contacts;
  /** Wall that balloons deform in place of one in this process; null: that one. With a source of contact sets of its
   *  own, a scene with a balloon needs such a wall, too. */
  std::shared_ptr<intervention::DeformableWall> wall;
  /** Source of the steps of the flow of blood in place of one in this process; null: that one. */
  std::shared_ptr<flow::FlowSource> flow;
  bool varied = true;  ///< false: load() refuses a state with a varied start
};

/** Loads controls of clients that a caller keeps. @param archive null: the state has none */
using LoadClients = std::function<void(Archive* archive, const simulation::Simulation& loaded)>;

/** Run of a scene: instruments, their drives, the scripted operator of a procedure, and on demand images and results.
 *
 *  Equal inputs give the trajectory of `simulate` and of the nodes, bit for bit. A session owns all that it needs; the
 *  world, which does not change, is shared. Errors are exceptions: InputError for an input of the user, and
 *  std::logic_error or a class derived from it for a wrong call, which changes nothing.
 *
 *  Threads: one at a time for one session. Any number of sessions may step at the same time, also of one world. */
class Session
{
public:
  /** Session at the beginning of a scene, as after reset().
   *  @throws InputError for a scene that cannot be simulated
   *  @throws std::invalid_argument for settings that contradict each other or the scene */
  explicit Session(std::shared_ptr<const World> world, SessionSettings settings = {});

  /** Session with a world of its own, see World::open(). */
  explicit Session(const std::string& scene, const std::vector<std::string>& overrides = {},
                   SessionSettings settings = {}, const ProgressReport& progress = {});

  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

  // ----------------------------------------------------------------------------------------------- beginning and end

  /** Returns to the beginning of the scene. The session is afterwards, bit for bit, as a new one.
   *  @param seed of the varied start and procedure (procedure::perturbed()); 0: the scene as it stands. It is the
   *         noise seed, too
   *  @throws InputError if an instrument would penetrate the wall at the start */
  void reset(std::uint64_t seed = 0);

  std::uint64_t seed() const;  ///< of the last reset, or of the loaded state

  /** Number of the step with which the run ends; at first that of the scene's duration. */
  std::uint64_t lastStep() const;
  void setLastStep(std::uint64_t step);

  /** True when the last step has been made, or the procedure is complete or has failed. */
  bool isOver() const;

  // --------------------------------------------------------------------------------------------------------- stepping

  /** Advances by steps with the commands of the operator, of clients (control()) and of the scene's drives, each for
   *  its instruments. Ends early where isOver().
   *  @return number of steps made */
  int step(int steps = 1);

  /** Commands of the operator for the next step, one per instrument; null without one. It observes once a step. */
  const std::vector<drive::HandCommand>* scriptedCommands();

  /** Advances by steps with the same commands in each, also beyond the end. The operator observes these steps, but its
   *  commands are not used.
   *  @param commands one per instrument of the scene, in its order; those of scriptedCommands() are accepted
   *  @throws std::invalid_argument unless there is one finite command for every instrument, with a pressure for
   *          instruments with a balloon only */
  void step(const std::vector<drive::HandCommand>& commands, int steps = 1);

  /** Control of an instrument by commands of clients: positions, velocities, forces, moves.
   *  @throws std::invalid_argument without SessionSettings::clients, or if no client drives the instrument */
  drive::HandControl& control(int instrument);

  /** Controls of all instruments, e.g. for a simulation::CommandPlayer. */
  simulation::DrivenHands& hands();

  /** Position that an instrument has reached in the scale of its commands: that of Simulation::reached(), plus the
   *  motion that faults of the robot have kept from it. */
  drive::HandMotion reached(int instrument) const;

  /** Stops of an instrument in that scale, see Simulation::stops(). */
  drive::Interval stops(int instrument) const;

  // ----------------------------------------------------------------------------------------------- flow of blood

  /** Heart rate, mean pressure and hyperaemia. @throws std::logic_error for a scene without the key `flow` @{ */
  const flow::FlowControls& flowControls() const;

  /** Sets them from the next step of the flow on.
   *  @throws std::invalid_argument for values outside flow::refusalOf() */
  void setFlowControls(const flow::FlowControls& controls);
  /** @} */

  // --------------------------------------------------------------------------------------- motion of the patient

  /** Heart rate, breathing rate and breath-hold. @throws std::logic_error for a scene without the key `motion` @{ */
  motion::MotionControls motionControls() const;

  /** Sets them: rates from the next beat or breath on, a breath-hold from the next end of an expiration on.
   *  @throws std::invalid_argument for values that motion::refusalOf() refuses; and for a heart rate other than the
   *          present one in a scene with the key `flow`, which drives the heart */
  void setMotionControls(const motion::MotionControls& controls);

  /** Reason for which setMotionControls() would refuse them; empty without one. */
  std::string refusalOf(const motion::MotionControls& controls) const;
  /** @} */

  // ---------------------------------------------------------------------------------------------- contrast medium

  /** Begins an injection with the next step of the flow.
   *  @param refill the syringe is filled before
   *  @throws std::logic_error for a scene without the key `contrast`
   *  @throws std::invalid_argument for one that refusalOf() refuses; nothing changes */
  void inject(const contrast::Injection& injection, bool refill = false);

  /** Ends the present injection; the rest stays in the syringe. @throws std::logic_error as inject() */
  void stopInjection();

  /** Ends the present injection, and fills the syringe. @throws std::logic_error as inject() */
  void refillSyringe();

  /** Reason for which inject() would refuse an injection now, with the remedy; empty without one. */
  std::string refusalOf(const contrast::Injection& injection, bool refill = false) const;

  // -------------------------------------------------------------------------------------- faults and random errors

  /** Commands that the handles followed in the last step, after all faults; none before the first one. */
  const std::vector<drive::HandCommand>& executedCommands() const;

  /** Faults of the robot: those of the scene, and added ones. They are part of a saved state; reset() leaves those of
   *  the scene. */
  const robot::CommandFaults& faults() const;

  /** Adds a fault that begins with the next step, or at its own start if that is later.
   *  @throws std::invalid_argument for an unknown instrument or impossible values */
  void addFault(const robot::FaultSettings& fault);

  /** Removes all faults of an axis.
   *  @return number of faults that were removed
   *  @throws std::invalid_argument for an unknown instrument */
  std::size_t removeFaults(int instrument, robot::FaultAxis axis);

  /** Seed of the errors and losses of sensors and of the faulty intervals, beside that of the scene. */
  std::uint64_t noiseSeed() const;

  /** Draws the errors, losses and faulty intervals of later steps with another seed. */
  void setNoiseSeed(std::uint64_t seed);

  // -------------------------------------------------------------------------------------------------------- observing

  /** Observation of the present state; it copies nothing. It holds until the next reset or load. */
  const Observation& observe() const;

  /** Makes the X-ray system and loads the patient, which the first image does otherwise.
   *  @throws InputError as image() */
  void prepareImages();

  /** Copies the shared wall before a balloon moves it. Without this call the copy is part of the step of the first
   *  inflation. Each reset() and load() begins with the shared wall again. Without a balloon nothing is copied. */
  void prepareInflation();

  /** X-ray image of the present state, as `simulate --x-ray` writes it: a function of state and view alone. Valid until
   *  the next image. fluoroscopy::writePng() writes it.
   *  @param view in clinical notation, e.g. "LAO 40"; empty: that of the scene
   *  @throws InputError for a scene without fluoroscopy, an unknown view, or a patient that cannot be loaded */
  const fluoroscopy::Frame& image(const std::string& view = "");

  /** Present wall of the vessel, deformed by a balloon in this process; empty without a vessel. With a wall of another
   *  process, the initial one. */
  const geometry::TriangleMesh& wall() const;

  /** Version of that wall: equal numbers in one run mean equal walls. */
  std::uint64_t wallVersion() const;

  // ----------------------------------------------------------------------------------------------------------- saving

  /** State on which the further trajectory depends, with operator, controls and seed. `simulate --from-state` and
   *  `rod_dynamics` load it, too, unless its seed is other than 0.
   *  @throws InputError for a scheme that cannot be saved */
  std::string save() { return save({}); }

  /** As save(), with controls of clients that the caller keeps in place of those of the session.
   *  @param clients archives them */
  std::string save(const std::function<void(Archive&)>& clients);

  /** Continues from a state of save(), of `simulate --save-state` or of `rod_dynamics`, bit for bit as the session that
   *  was saved. Results, and sums over past steps, begin at the state. A refused state has no effect.
   *  @param origin names the state in errors
   *  @throws InputError for a damaged state, one of another version, scene or vessel, or one that
   * SessionSettings::varied excludes */
  void load(const std::string& state, const std::string& origin = "state") { load(state, origin, {}); }

  /** As load(), with controls of clients that the caller keeps.
   *  @param clients loads them; it may be called before the state is refused */
  void load(const std::string& state, const std::string& origin, const LoadClients& clients);

  /** Takes over the state of a scene with other parameters, e.g. friction, stiffness or limits, but the same
   *  instruments, nodes and vessel (World::with()). The commands of the drives go on at the time of the state. A
   *  refused state has no effect.
   *  @return what was dropped, as texts
   *  @throws InputError as load(), and for a state of other instruments or nodes */
  std::vector<std::string> adopt(const std::string& state, const std::string& origin = "state");

  // ---------------------------------------------------------------------------------------------------------- results

  /** Ends the results and writes them into a folder, which is created if missing. Later steps are not added.
   *  @throws std::logic_error without SessionSettings::results
   *  @throws InputError if a file cannot be written */
  void finish(const std::string& folder, RecordFiles files = RecordFiles::kAll);

  /** Results so far. @throws std::logic_error without SessionSettings::results */
  const RunRecord& record() const;

  double stepSeconds() const;  ///< computing time of the last step of the simulation [s]

  // ------------------------------------------------------------------------------------------------------------ parts

  const World& world() const;
  const std::shared_ptr<const World>& sharedWorld() const;

  /** Scene of the run: that of the world, varied by the seed. */
  const scene::Scene& scene() const;

  /** Simulation, for what Observation does not have. Steps that are made with it directly are part of neither results
   *  nor procedure. It holds until the next reset or load. @{ */
  const simulation::Simulation& simulation() const;
  simulation::Simulation& simulation();
  /** @} */

  /** Scripted operator of the procedure; null without one. */
  const procedure::Operator* scriptedOperator() const;

  /** Detector of the wall; null without a vessel, or with SessionSettings::contacts. */
  const contact::Detector* detector() const;

private:
  struct Run;
  struct Imaging;

  std::shared_ptr<const scene::Scene> variedScene(std::uint64_t seed) const;
  std::unique_ptr<Run> begin(std::uint64_t seed) const;
  Run& run() const;
  void start(std::unique_ptr<Run> run);
  const intervention::DeformableWall* deformableWall() const;
  const std::vector<drive::HandCommand>& nextCommands();
  void requireValid(const std::vector<drive::HandCommand>& commands) const;
  void advance(const std::vector<drive::HandCommand>& commands);
  void setWantedControls();
  void beginWantedInjection();

  std::shared_ptr<const World> world_;
  SessionSettings settings_;
  std::uint64_t check_every_ = 1;  ///< steps between two searches for nodes outside the wall
  std::uint64_t last_step_ = 0;
  std::unique_ptr<Run> run_;          ///< null after the session was moved from
  std::unique_ptr<Imaging> imaging_;  ///< null before the first image
};

}  // namespace endovascular_sim::session
