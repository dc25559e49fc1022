#include "drive/joint_command.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace endovascular_sim::drive
{
namespace
{

constexpr std::array<CommandKind, 6> kKinds = {CommandKind::kServoPosition, CommandKind::kServoRelative,
                                               CommandKind::kServoVelocity, CommandKind::kServoForce,
                                               CommandKind::kMovePosition,  CommandKind::kMoveRelative};

/** Values of the three joints; empty where there is none. */
using JointValues = std::array<std::optional<double>, 3>;

/** Assigns the values of named joints. @return false for a repeated joint */
bool assignNamed(const std::vector<std::string>& names, const std::vector<double>& values, JointValues& joints)
{
  const std::array<const char*, 3> known = {kInsertionJoint, kRotationJoint, kPressureJoint};
  for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i)
  {
    const auto joint = std::find(known.begin(), known.end(), names[i]);
    if (joint == known.end())
      continue;
    std::optional<double>& value = joints[static_cast<std::size_t>(joint - known.begin())];
    if (value)
      return false;
    value = values[i];
  }
  return joints[0] && joints[1];
}

}  // namespace

const char* nameOf(CommandKind kind)
{
  switch (kind)
  {
    case CommandKind::kServoPosition:
      return "servo_jp";
    case CommandKind::kServoRelative:
      return "servo_jr";
    case CommandKind::kServoVelocity:
      return "servo_jv";
    case CommandKind::kServoForce:
      return "servo_jf";
    case CommandKind::kMovePosition:
      return "move_jp";
    case CommandKind::kMoveRelative:
      break;
  }
  return "move_jr";
}

std::optional<CommandKind> commandKind(const std::string& name)
{
  for (const CommandKind kind : kKinds)
    if (name == nameOf(kind))
      return kind;
  return std::nullopt;
}

bool isStateCommand(const std::string& name)
{
  constexpr std::array<const char*, 8> kNames = {"enable", "disable", "pause", "resume",
                                                 "home",   "unhome",  "hold",  "free"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

std::optional<JointCommand> jointCommand(CommandKind kind, const std::vector<std::string>& names,
                                         const std::vector<double>& values)
{
  JointValues joints;
  if (!names.empty())
  {
    if (!assignNamed(names, values, joints))
      return std::nullopt;
  }
  else
  {
    if (values.empty() || values.size() > joints.size())
      return std::nullopt;
    std::copy(values.begin(), values.end(), joints.begin());
  }
  const bool by_rate = kind == CommandKind::kServoVelocity || kind == CommandKind::kServoForce;
  if (by_rate && joints[2].value_or(0.0) != 0.0)
    return std::nullopt;
  return JointCommand{kind, *joints[0], joints[1], by_rate ? std::nullopt : joints[2]};
}

}  // namespace endovascular_sim::drive
