#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <ros/time.h>

#include "nodes/conversions/procedure_conversions.h"
#include "nodes/session/bag_writer.h"
#include "nodes/session/throttle.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{

/** Bag of an offline session: scene, vessel, the commands of each step, states of instruments and balloons, and the
 *  procedure, the flow of blood, contrast medium and the motion of the patient, as the session node records them. It
 * can be played and replayed. Times are simulated ones. */
class OfflineBag
{
public:
  /** @param session at its beginning
   *  @param subject text of session/info
   *  @throws InputError when the file cannot be written */
  OfflineBag(const std::string& file, const session::Session& session, const std::string& subject);

  /** Adds a step; to be called after each step. */
  void addStep(const session::Session& session);

  /** Writes the end, and closes the bag.
   *  @throws InputError when the bag could not be written */
  void close();

private:
  void addVessel(const session::World& world);
  void addProcedure(const procedure::Operator& scripted, std::uint64_t step);
  void addState(const simulation::Simulation& simulation);
  void addNetwork(const session::Session& session);
  void addControls(const flow::FlowControls& controls);
  void addControls(const motion::MotionControls& controls);
  void addMotion(const simulation::Simulation& simulation);
  void addCells(const session::World& world);
  void addInjections(const simulation::ContrastInjections& injections);
  void addContrast(const simulation::Simulation& simulation);
  void addBlood(const simulation::BloodCoupling& blood);
  template <typename Message>
  void write(const char* topic, Message message);

  BagWriter bag_;
  ros::Time now_;  ///< simulated time of the present step
  std::uint64_t steps_ = 0;
  Throttle pose_, heart_, flow_;
  ProcedureMessages procedure_;
  std::size_t events_ = 0;  ///< of balloons and stents that are written
  bool has_balloon_;
  // Last written ones:
  std::optional<flow::FlowControls> controls_;
  std::optional<motion::MotionControls> motion_controls_;
  std::uint64_t injection_step_ = 0;  ///< of the newest injections
  std::size_t injections_ = 0;        ///< number of them that are written
  std::uint64_t flow_steps_ = 0;      ///< number of steps of the flow that had begun at the last step
  double flow_time_step_ = 0.0;       ///< [s]
  std::vector<std::string> lines_;    ///< frames of the pressure lines
};

}  // namespace endovascular_sim::nodes
