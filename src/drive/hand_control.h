#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drive/arbiter.h"
#include "drive/axis_control.h"
#include "drive/command_gate.h"
#include "drive/drive_limits.h"
#include "drive/joint_command.h"
#include "drive/operating_state.h"

namespace endovascular_sim::drive
{

/** Feedback of one instrument to its control. */
struct HandFeedback
{
  AxisFeedback insertion;  ///< [m], [N]
  AxisFeedback rotation;   ///< [rad], [N·m]
};

/** Position of an instrument's joints that a step uses. */
struct HandSetpoint
{
  HandMotion motion;
  std::optional<double> pressure;  ///< empty before the first command of a pressure [Pa]
};

/** Control of one instrument by the commands of clients: modes, limits, time-outs and operating state.
 *
 *  Each mode reduces to insertion and rotation per step, as a function of the commands between the steps, the simulated
 *  time and the feedback. Where the instrument waits at a stop, the setpoint stays at the stop in every mode but that
 * of absolute positions, which are the client's. A new command replaces the one before, of any mode. One client drives
 * at a time (Arbiter), until `disable`. `disable` and `pause` end any motion; both hold the instrument. */
class HandControl
{
public:
  /** @param start position at the first step
   *  @param limits completed ones (DriveLimits::completed()) */
  HandControl(const HandMotion& start, const DriveLimits& limits);

  /** Examines a command of a client and takes it over if it is accepted.
   *  @param client name of the sender
   *  @param command empty for a malformed one */
  CommandVerdict command(const std::string& client, const std::optional<JointCommand>& command);

  /** Executes a command without values (kStateCommands), if the arbiter permits it. `hold` brakes to rest. After `free`
   * the instrument gives way to the wire's force, as if nothing held it, until the next command.
   *  @return false for another word or a refusal, with the reason in the arbiter */
  bool stateCommand(const std::string& client, const std::string& word);

  /** Advances by a step. @return setpoint of the step */
  const HandSetpoint& next(double dt, const HandFeedback& feedback);

  /** True if a stop of the instrument, or the end of its range, held the last step of an insertion back. */
  bool isStopped() const { return is_stopped_; }

  const HandSetpoint& setpoint() const { return setpoint_; }
  HandMotion goal() const;  ///< goal of a move, else the last commanded position

  const ControlState& state() const { return state_; }
  const Arbiter& arbiter() const { return arbiter_; }
  RejectedCommands rejected() const;  ///< also clamped positions of a stream

  /** Takes over the number and the last reason of rejections, nothing else, e.g. of a control that has been discarded
   *  because one of several commands was rejected. */
  void copyRejections(const HandControl& other) { arbiter_.copyRejections(other.arbiter_); }

  /** Rests at a position, without a driver, as after a pause of all clients.
   *  @param pressure empty: that of the scene [Pa] */
  void restAt(const HandMotion& position, std::optional<double> pressure);

  /** Saves or loads all data on which the further motion depends: commands, state and their ages, but not the driver,
   *  who may have left, nor the numbers of commands.
   *  @throws ArchiveError for invalid data */
  void archive(Archive& archive);

private:
  enum class Mode
  {
    kStream,  ///< positions
    kRate,    ///< velocity or force; at rest without a command
    kMove,
    kIncrements,  ///< differences of positions
    kFree,        ///< effort 0 until the next command
  };

  CommandVerdict examine(const std::string& client, const std::optional<JointCommand>& command);
  CommandVerdict execute(JointCommand command);
  CommandVerdict stream(const JointCommand& command);
  CommandVerdict rate(JointCommand command);
  CommandVerdict move(const JointCommand& command);
  bool isPermitted(double& value, const Interval& interval, bool& clamped) const;
  std::optional<double> wantedPressure(const JointCommand& command) const;
  std::string reasonOf(CommandVerdict verdict) const;
  bool reject(CommandVerdict verdict, const std::string& command, const std::string& client);
  void enterRate();
  void stop();
  void setState(OperatingState state, const std::string& reason);
  bool home(const std::string& client);
  bool holdOrFree(const std::string& client, const std::string& word);
  void endMove();

  HandMotion start_;
  DriveLimits limits_;
  CommandGate gate_;
  AxisControl insertion_;
  AxisControl rotation_;
  Mode mode_ = Mode::kStream;
  HandSetpoint setpoint_;
  bool is_stopped_ = false;
  HandMotion slipped_;  ///< scale of the commands minus position of the instrument, at the last step
  bool is_homing_ = false;
  ControlState state_;
  Arbiter arbiter_;
};

/** Gives a command by its CRTK name, with or without values.
 *  @param names, values joints, as jointCommand() takes them
 *  @return false for a refusal, with the reason in HandControl::arbiter() */
bool give(HandControl& control, const std::string& client, const std::string& word,
          const std::vector<std::string>& names, const std::vector<double>& values);

}  // namespace endovascular_sim::drive
