#pragma once

#include <optional>
#include <string>
#include <vector>

namespace endovascular_sim::drive
{

/** Commands to the joints of an instrument, by their CRTK names. */
enum class CommandKind
{
  kServoPosition,  ///< servo_jp: stream of positions
  kServoRelative,  ///< servo_jr: stream of differences from the last commanded position
  kServoVelocity,  ///< servo_jv
  kServoForce,     ///< servo_jf: force and torque, reached by a motion in proportion to the difference (admittance)
  kMovePosition,   ///< move_jp: a goal, reached with limited speed and acceleration
  kMoveRelative,   ///< move_jr: as move_jp, relative to the present setpoint
};

/** CRTK name of a kind of command, e.g. "servo_jp". */
const char* nameOf(CommandKind kind);

/** Kind with a CRTK name; none for another text. */
std::optional<CommandKind> commandKind(const std::string& name);

/** CRTK names of the commands without values, for messages. */
constexpr auto kStateCommands = "enable, disable, pause, resume, home, unhome, hold, free";

/** True for the commands without values. */
bool isStateCommand(const std::string& name);

// Names of the joints of an instrument.
constexpr auto kInsertionJoint = "insertion";
constexpr auto kRotationJoint = "rotation";
constexpr auto kPressureJoint = "pressure";  ///< only instruments with a balloon have it

/** Command to the joints of one instrument. */
struct JointCommand
{
  CommandKind kind = CommandKind::kServoPosition;
  double insertion = 0.0;          ///< position [m], velocity [m/s] or force [N]
  std::optional<double> rotation;  ///< position [rad], velocity [rad/s] or torque [N·m]; empty: the joint holds
  std::optional<double> pressure;  ///< pressure, or its difference [Pa]; empty: the joint holds
};

/** Command from names and values of joints.
 *
 *  Named joints may have any order; insertion and rotation are required once each, pressure may be missing, and other
 *  names are ignored. Without names the values are insertion, rotation and pressure in this order, and the last ones
 * may be missing.
 *  @param values positions, velocities or efforts, as the kind requires
 *  @return none for joints that are missing or repeated, for more than three values without names, and for a pressure
 *          other than zero in a command of velocities or forces */
std::optional<JointCommand> jointCommand(CommandKind kind, const std::vector<std::string>& names,
                                         const std::vector<double>& values);

}  // namespace endovascular_sim::drive
