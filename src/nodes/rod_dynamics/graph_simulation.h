#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ros/ros.h>

#include "nodes/rod_dynamics/contact_force_publisher.h"
#include "nodes/rod_dynamics/control/loop_costs.h"
#include "nodes/rod_dynamics/control/pace.h"
#include "nodes/rod_dynamics/control/simulation_clock.h"
#include "nodes/rod_dynamics/instruments/drive_commands.h"
#include "nodes/rod_dynamics/instruments/graph_contrast.h"
#include "nodes/rod_dynamics/instruments/graph_hardware.h"
#include "nodes/rod_dynamics/instruments/graph_hemodynamics.h"
#include "nodes/rod_dynamics/instruments/graph_motion.h"
#include "nodes/rod_dynamics/instruments/hand_force_renderer.h"
#include "nodes/rod_dynamics/instruments/instrument_publisher.h"
#include "nodes/rod_dynamics/procedure_publisher.h"
#include "nodes/rod_dynamics/remote_contact_source.h"
#include "nodes/rod_dynamics/remote_deformable_wall.h"
#include "nodes/rod_dynamics/remote_flow_source.h"
#include "nodes/rod_dynamics/rod_publisher.h"
#include "nodes/rod_dynamics/vessel_server_monitor.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{

/** Session of a scene with its connections to the graph: the vessel, the contact node, the flow of blood, the commands
 * to its instruments, and all of its topics. */
class GraphSimulation
{
public:
  /** @param parameters handle of the private parameters `commands`, `contact_patience` and `publish_clock`
   *  @throws InputError for an invalid parameter or file of commands */
  GraphSimulation(ros::NodeHandle& node, const ros::NodeHandle& parameters, scene::Scene scene, Pace pace);

  /** Waits for the vessel and for the nodes of contact and flow, and opens the session. @return false when ROS shut
   * down before */
  bool connect();

  /** Advances by one step with the commands of the drives, and publishes it. */
  void step();

  /** While no step is taken: publishes the commands of the last step with the rendered forces scaled by a share. */
  void publishHeld(double share);

  /** Lets the rendered forces approach those of the simulation from zero, after publishHeld(). */
  void fadeForcesIn() { renderer_.reset(); }

  /** Publishes the steps that wait for the rest of their group, where no step follows soon. */
  void publishWaitingSteps() { publisher_.publishGroup(); }

  /** Publishes the beginning of a run: the time, and an empty map of the wall forces. */
  void publishBeginning();

  /** Publishes the controls of circulation and motion at the beginning of a run.
   *  @param run its number */
  void publishControls(std::uint32_t run);

  /** Publishes the end: forces of zero, and the last map of the wall forces. */
  void publishEnd(const std::string& reason);

  /** Publishes the state of all instruments, as InstrumentPublisher::setSimulationState(). */
  void setState(drive::OperatingState state, const std::string& reason);

  /** Returns to the beginning of the scene.
   *  @throws InputError when a node that keeps the wall does not respond */
  void reset();

  /** State in the format of Simulation::save(), followed by that of the scripted operator and of the drives.
   *  @throws InputError for a scene whose state cannot be saved */
  std::string save();

  /** Continues from a state of save(), or of `simulate`. A refused one has no effect.
   *  @param origin names the state in errors
   *  @throws InputError for an invalid state, one of another scene, or a node that does not respond */
  void load(const std::string& state, const std::string& origin);

  /** Executes a call of contrast/inject between two steps.
   *  @return what is injected
   *  @throws InputError for what is impossible; nothing changes */
  std::string inject(const InjectContrast::Request& request);

  const scene::Scene& scene() const { return scene_; }
  const simulation::Simulation& simulation() const { return session_->simulation(); }
  /** Initial centreline of the vessel; empty without one. */
  const vessel::CentrelineTree& centreline() const;
  RemoteContactSource* contacts() { return contacts_.get(); }  ///< null without a vessel
  const RemoteContactSource* contacts() const { return contacts_.get(); }
  RemoteFlowSource* flow() { return flow_.get(); }  ///< null without flow of blood in the scene

  /** Reports whether the next step takes a step of the flow, which `hemodynamics` has computed meanwhile. */
  bool needsFlow() const;

  /** Reports whether the next step may need a wall that vessel_server has not sent. */
  bool needsWall();

  DriveCommands& drives() { return drives_; }
  const LoopTimes& times() const { return costs_.last(); }  ///< of the last step
  const InstrumentPublisher& instruments() const { return instruments_; }
  SimulationClock& clock() { return clock_; }

  /** Reports whether a person does the steps of a procedure. */
  bool isGuided() const { return scene_.procedure && scene_.procedure->guided; }

  /** Observer of the procedure; null without one, and before connect(). */
  const procedure::Operator* observer() const { return session_ ? session_->scriptedOperator() : nullptr; }

  /** Reports whether forces are faded after rejected steps. */
  bool isFaded() const { return renderer_.isFaded(); }

  /** Reports whether the topics of the recording have subscribers. */
  bool isRecorded() const { return publisher_.isRecorded() && (!forces_ || forces_->isSampled()); }

  /** Reports whether vessel_server has ended, and the deformed wall with it. */
  bool isWithoutVessel() const { return server_ && server_->hasEnded(); }

private:
  std::optional<vessel::Vessel> waitForVessel();
  void connectFlow();
  const std::vector<drive::HandCommand>& nextCommands();
  void publishStep(const std::vector<drive::HandCommand>& commands, bool counted);
  ros::Time now() const { return clock_.stamp(session_ ? simulation().steps() : 0); }
  void beginRun();

  ros::NodeHandle& node_;
  scene::Scene scene_;
  LoopCosts costs_;
  SimulationClock clock_;
  std::shared_ptr<RemoteContactSource> contacts_;  ///< null without a vessel
  std::unique_ptr<VesselServerMonitor> server_;    ///< null without a vessel
  std::shared_ptr<RemoteDeformableWall> wall_;     ///< null without a vessel or without a balloon
  std::shared_ptr<RemoteFlowSource> flow_;         ///< null without flow of blood in the scene
  std::optional<session::Session> session_;        ///< none before connect()
  std::optional<ProcedurePublisher> procedure_;    ///< none without a procedure in the scene
  RodPublisher publisher_;
  std::unique_ptr<ContactForcePublisher> forces_;  ///< null without a vessel
  DriveCommands drives_;
  GraphHardware hardware_;
  std::optional<GraphHemodynamics> hemodynamics_;  ///< none without flow of blood, and before connect()
  std::optional<GraphContrast> contrast_;          ///< none without contrast medium, and before connect()
  std::optional<GraphMotion> motion_;              ///< none where the patient rests, and before connect()
  InstrumentPublisher instruments_;
  HandForceRenderer renderer_;
};

}  // namespace endovascular_sim::nodes
