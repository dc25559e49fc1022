#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/session/session_bag.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{

/** Session of a recording: with its scene and its vessel, and with stale contact sets where they came too late in it.
 */
class RecordedSimulation
{
public:
  /** @param file path of the bag, for errors
   *  @param results true: gathers the results, as SessionSettings::results
   *  @throws InputError when scene or vessel of the recording are damaged or missing */
  RecordedSimulation(const SessionBag& recording, const std::string& file, bool results = false);

  const session::Session& session() const { return *session_; }
  session::Session& session() { return *session_; }
  const simulation::Simulation& simulation() const { return session().simulation(); }

  /** Simulates the next step with its recorded input.
   *  @throws InputError when the input does not match the instruments of the scene */
  void step(const DriveApplied& applied);

  /** Simulates the next step by the operator and the drives of the scene, with the recorded contact sets. */
  void stepByScene(const DriveApplied& applied);

private:
  struct Contacts;

  void prepare(const DriveApplied& applied);
  void setMotionControls(motion::MotionControls controls);
  void follow(const simulation::ContrastInput& input);

  std::string file_;
  std::shared_ptr<Contacts> contacts_;  ///< null without a vessel
  std::optional<session::Session> session_;
  std::map<std::uint64_t, flow::FlowControls> controls_;             ///< of the flow of blood, by their first step
  std::map<std::uint64_t, motion::MotionControls> motion_controls_;  ///< in the same way
  std::map<std::uint64_t, std::vector<simulation::ContrastInput>> injections_;  ///< of contrast medium, in the same way
  std::vector<drive::HandCommand> commands_;
};

/** Comparison of a recorded session with its simulation. */
struct ReplayOutcome
{
  std::uint64_t compared = 0;                    ///< number of steps compared, from the first one
  std::uint64_t different = 0;                   ///< number of these steps that differ
  std::optional<std::uint64_t> first_different;  ///< first step that differs
  std::uint64_t recorded_hash = 0;               ///< state hash of that step in the recording
  std::uint64_t computed_hash = 0;               ///< state hash of that step in the simulation
  std::uint64_t steps = 0;                       ///< number of steps of the session, as far as the bag reports it
  std::string incomplete;                        ///< reason for which not every step was compared; empty if each was
};

/** Simulates the recorded steps up to the first one that is missing, and compares their state hashes.
 *  @param keep_going true: counts all steps that differ instead of ending at the first one
 *  @param after called after every step
 *  @throws InputError as RecordedSimulation::step() */
ReplayOutcome replay(const SessionBag& recording, RecordedSimulation& session, bool keep_going,
                     const std::function<void()>& after = nullptr);

}  // namespace endovascular_sim::nodes
