#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <crtk_msgs/StringStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "endovascular_sim/InstrumentCommand.h"
#include "nodes/conversions/command_diagnostics.h"
#include "nodes/rod_dynamics/instruments/grip_watch.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "scene/model/scene.h"
#include "simulation/driven_hands.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Commands to the instruments of a scene from the CRTK topics (simulation::DrivenHands). A client is known by the name
 *  of its node. */
class DriveCommands
{
public:
  /** Subscribes to the topics of the instruments that clients drive.
   *  @param scene must outlive this object
   *  @param file of commands that are given at their times, as to `simulate`; empty: none
   *  @throws InputError for an invalid file of commands */
  DriveCommands(ros::NodeHandle& node, const scene::Scene& scene, const std::string& file = "");

  /** Commands of the coming step, one per instrument.
   *  @param scripted commands of the scripted operator; null without one
   *  @param faults that act on these commands, of which the controls see nothing */
  const std::vector<drive::HandCommand>& next(const simulation::Simulation& simulation,
                                              const std::vector<drive::HandCommand>* scripted,
                                              const robot::CommandFaults& faults);

  /** Gives commands to instruments as a client, all of them or none. Rejections are counted.
   *  @return reason of the first refusal; empty if all were accepted */
  std::string give(const std::string& client, const std::vector<InstrumentCommand>& commands);

  /** Begins a new run at the start of the scene: no client drives. */
  void reset();

  /** Holds all instruments that clients drive where they are. */
  void restAt(const simulation::Simulation& simulation);

  /** Commands at present, one per instrument, as in the last step. */
  std::vector<drive::HandCommand> present(const simulation::Simulation& simulation);

  /** Continues the file of commands at a time [s]. */
  void playFrom(double time);

  /** Saves or loads the controls. @throws ArchiveError for invalid data */
  void archive(Archive& archive);

  /** Changes whenever an operating state is to be published. Callable from any thread. */
  std::uint64_t revision() const { return revision_; }

  /** Operating states, one per instrument; those that no client drives are enabled. Callable from any thread. */
  std::vector<drive::ControlState> states();

  /** Goals of all instruments: of a move, else the last command.
   *  @param used commands of the last step, for the instruments that no client drives */
  void goals(const std::vector<drive::HandCommand>& used, std::vector<drive::HandCommand>& goals);

  /** Reports, one per instrument that clients drive. Callable from any thread. */
  std::vector<CommandReport> reports();

private:
  void subscribe(ros::NodeHandle& node, std::size_t instrument);
  void receive(std::size_t instrument, drive::CommandKind kind,
               const ros::MessageEvent<sensor_msgs::JointState const>& event);
  void receiveWord(std::size_t instrument, const std::string& client, const std::string& word);
  void updateRevision();

  void watchGrips(const simulation::Simulation& simulation);
  std::string giveOne(const std::string& client, const InstrumentCommand& command, std::size_t n);
  void playFile(double time);

  const scene::Scene& scene_;
  std::optional<simulation::CommandPlayer> file_;  ///< commands of a file, before the first step
  std::mutex mutex_;                               ///< guards the next three
  std::optional<simulation::DrivenHands> hands_;
  std::vector<GripWatch> grips_;                     ///< one per instrument
  std::optional<simulation::CommandPlayer> player_;  ///< commands of a file
  std::atomic<std::uint64_t> revision_{0};
  DirectCallbackQueue queue_;
  std::vector<std::vector<ros::Subscriber>>
      subscribers_;  ///< of every instrument, empty where no client drives; last, so that they end first
};

}  // namespace endovascular_sim::nodes
