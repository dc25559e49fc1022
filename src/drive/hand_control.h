#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drive/axis_control.h"
#include "drive/command_gate.h"
#include "drive/drive_limits.h"
#include "drive/joint_command.h"

namespace endovascular_sim::drive
{

/** Operating state of an instrument, as CRTK defines it. */
struct OperatingState
{
  std::string state;           ///< DISABLED, ENABLED or PAUSED
  bool is_homed = true;        ///< false after `unhome`, until the end of `home`
  bool is_busy = false;        ///< true during a move or homing
  std::string reason;          ///< reason of a state other than ENABLED, or a warning
  std::uint64_t revision = 0;  ///< incremented whenever the state is to be published, also without a change
};

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
 * at a time: the first one whose command is accepted, until it sends none for the time-out, or until `disable`.
 * `disable` and `pause` end any motion; both hold the instrument. */
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

  /** Executes enable, disable, pause, resume, home, unhome, hold or free. Every client may enable, disable and pause;
   * the others are refused while another client drives. `hold` brakes to rest. After `free` the instrument gives way to
   * the wire's force, as if nothing held it, until the next command.
   *  @return false for another word or a refusal, with the reason in lastRefusal() */
  bool stateCommand(const std::string& client, const std::string& word);

  /** Advances by a step. @return setpoint of the step */
  const HandSetpoint& next(double dt, const HandFeedback& feedback);

  /** True if a stop of the instrument, or the end of its range, held the last step of an insertion back. */
  bool isStopped() const { return is_stopped_; }

  const HandSetpoint& setpoint() const { return setpoint_; }
  HandMotion goal() const;  ///< goal of a move, else the last commanded position

  const OperatingState& state() const { return state_; }
  const std::string& driver() const { return driver_; }             ///< client that drives; empty without one
  const std::string& lastRefusal() const { return last_refusal_; }  ///< reason of the last refusal
  std::uint64_t accepted() const { return accepted_; }
  RejectedCommands rejected() const;

  /** Takes over the number and the last reason of rejections, nothing else, e.g. of a control that has been discarded
   *  because one of several commands was rejected. */
  void copyRejections(const HandControl& other);

  double silence() const;  ///< simulated time since the last accepted command [s]; infinite before the first

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

  bool isDrivenByAnother(const std::string& client) const;
  CommandVerdict examine(const std::string& client, const std::optional<JointCommand>& command);
  CommandVerdict execute(JointCommand command);
  CommandVerdict stream(const JointCommand& command);
  CommandVerdict rate(JointCommand command);
  CommandVerdict move(const JointCommand& command);
  bool isPermitted(double& value, const Interval& interval, bool& clamped) const;
  std::optional<double> wantedPressure(const JointCommand& command) const;
  std::string reasonOf(CommandVerdict verdict) const;
  void enterRate();
  void stop();
  void setState(const std::string& state, const std::string& reason);
  void home(const std::string& client);
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
  OperatingState state_;
  std::string driver_;
  double driver_silence_ = 0.0;  ///< since the last command of the driver [s]
  double silence_ = 0.0;         ///< since the last accepted command [s]
  std::uint64_t accepted_ = 0;
  RejectedCommands rejected_;
  std::string last_refusal_;
};

}  // namespace endovascular_sim::drive
