#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drive/command_gate.h"
#include "drive/hand_control.h"
#include "drive/joint_command.h"
#include "robot/joint_link.h"
#include "robot/play_axis.h"
#include "robot/robot_model.h"

namespace endovascular_sim::robot
{

/** Values of the motions of an instrument, by Motion. */
using Motions = std::array<double, 3>;

/** Instrument that a robot drives. */
struct RobotInstrument
{
  std::string name;
  drive::BeyondLimit beyond = drive::BeyondLimit::kRefuse;  ///< treatment of commands beyond the joints' limits
  double time_out = 0.2;                                    ///< drive.limits.time_out [s]
  Motions start = {};                                       ///< at the start of the scene
};

/** Command to one instrument of a robot. */
struct InstrumentCommand
{
  std::size_t instrument = 0;
  drive::JointCommand joints;
};

/** Result of a command to a robot. */
struct RobotAnswer
{
  drive::CommandVerdict verdict = drive::CommandVerdict::kAccepted;
  std::string reason;                       ///< of a rejection
  std::vector<InstrumentCommand> commands;  ///< to give to the instruments; empty after a rejection
};

/** Measured, set or wanted values of the linked joints of a robot, in the order of the links. */
struct JointValues
{
  std::vector<double> position, velocity, effort;
};

/** Commands to the joints of a robot, converted to commands to its instruments.
 *
 *  A command has the kinds and the rules of drive::HandControl: joints with names in any order, or without names in the
 *  order of the links; joints that are missing hold. It goes to the instruments of its joints, all or none. Positions
 *  pass the play of each joint; velocities do so at the resolution of the calls of follow(); forces take the play up at
 *  once. The instrument determines the motion between the commands. Times are those of the instruments. */
class RobotControl
{
public:
  /** @param links valid ones (findFault()); their instruments are those of the list */
  RobotControl(RobotModel model, std::vector<JointLink> links, std::vector<RobotInstrument> instruments);

  /** Examines a command of a client.
   *  @param names of the joints; empty: the links in their order
   *  @param values positions, velocities or efforts, as the kind requires */
  RobotAnswer command(const std::string& client, drive::CommandKind kind, const std::vector<std::string>& names,
                      const std::vector<double>& values, double time);

  /** Examines enable, disable, pause, resume, home, unhome, hold or free, which go to all instruments.
   *  @return reason of a refusal; empty if it is permitted */
  std::string stateCommand(const std::string& client, const std::string& word, double time);

  /** Takes over the setpoint of an instrument after a step.
   *  @return velocities of an instrument whose joints have used up their play */
  std::optional<InstrumentCommand> follow(std::size_t instrument, const Motions& setpoint, double time);

  /** Takes over the operating state of an instrument. */
  void setState(std::size_t instrument, const drive::ControlState& state) { states_[instrument] = state; }

  /** Replaces the reason of an instrument's state. */
  void setReason(std::size_t instrument, const std::string& reason) { states_[instrument].reason = reason; }

  /** State of the robot: the worst of its instruments, homed if all are, busy if one is. */
  drive::ControlState state() const;

  /** Position of the joint of a link.
   *  @param motion of its instrument */
  double position(std::size_t link, double motion) const;

  /** Positions, or velocities, of all movable joints in the order of the model, with those that no link moves.
   *  @param linked values of the linked joints
   *  @param positions false for velocities */
  std::vector<double> allJoints(const std::vector<double>& linked, bool positions) const;

  /** Names of all movable joints in the order of the model. */
  std::vector<std::string> allNames() const;

  const RobotModel& model() const { return model_; }
  const std::vector<JointLink>& links() const { return links_; }
  const std::vector<RobotInstrument>& instruments() const { return instruments_; }
  /** Index of the instrument of a link. */
  std::size_t instrumentOf(std::size_t link) const { return instrument_of_[link]; }

  const drive::Arbiter& arbiter() const { return arbiter_; }

private:
  struct Channel
  {
    std::array<PlayAxis, 3> axes;
    drive::CommandKind kind = drive::CommandKind::kServoPosition;  ///< of the last command
    double commanded_at = -1e300;                                  ///< time of the last command [s]
    double followed_at = 0.0;                                      ///< time of the last setpoint [s]
  };
  using Values = std::vector<std::optional<double>>;  ///< one per link; empty: the joint holds

  std::optional<Values> assign(const std::vector<std::string>& names, const std::vector<double>& values,
                               std::string& reason) const;
  void advanceTo(double time);
  drive::CommandVerdict examine(const std::string& client, drive::CommandKind kind, Values& values, std::string& reason,
                                bool& clamped) const;
  drive::CommandVerdict examineLimits(std::size_t link, drive::CommandKind kind, double& value, std::string& reason,
                                      bool& clamped) const;
  bool isReady(std::size_t instrument, drive::CommandKind kind, std::string& reason) const;
  std::optional<InstrumentCommand> convert(std::size_t instrument, drive::CommandKind kind, const Values& values,
                                           Channel& channel) const;
  double play(const PlayAxis& axis) const { return axis.link ? links_[*axis.link].backlash : 0.0; }
  void followInstruments(double time);
  std::optional<InstrumentCommand> rates(std::size_t instrument) const;
  RobotAnswer reject(const std::string& client, drive::CommandKind kind, drive::CommandVerdict verdict,
                     const std::string& reason);

  RobotModel model_;
  std::vector<JointLink> links_;
  std::vector<RobotInstrument> instruments_;
  std::vector<std::size_t> instrument_of_;  ///< of each link
  std::vector<Channel> channels_;           ///< one per instrument
  std::vector<drive::ControlState> states_;
  double time_ = 0.0;  ///< of the last command or step [s]
  drive::Arbiter arbiter_;
};

}  // namespace endovascular_sim::robot
