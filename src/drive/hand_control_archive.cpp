#include "common/archive.h"
#include "common/archive_checks.h"
#include "drive/hand_control.h"

// Saved states of the control of an instrument and of its parts.

namespace endovascular_sim::drive
{
namespace
{

void archiveMotion(Archive& archive, HandMotion& motion)
{
  archive(motion.insertion, motion.rotation);
  requireFinite(motion.insertion, motion.rotation);
}

void archiveText(Archive& archive, std::string& text)
{
  std::vector<char> letters(text.begin(), text.end());
  archive(letters);
  text.assign(letters.begin(), letters.end());
}

}  // namespace

void TrapezoidalMove::archive(Archive& archive)
{
  archive(start_, goal_, direction_, velocity_, cruising_, ramp_, cruise_, braking_);
  requireFinite(start_, goal_, direction_, velocity_, cruising_, ramp_, cruise_, braking_);
}

void AxisControl::archive(Archive& archive)
{
  archive(mode_, target_, position_, velocity_, move_, move_time_);
  requireIndex(static_cast<int>(mode_), 0, static_cast<int>(Mode::kMove) + 1);
  requireFinite(target_, position_, velocity_, move_time_);
}

void CommandGate::archive(Archive& archive)
{
  archiveMotion(archive, target_);
  archiveMotion(archive, position_);
  archiveMotion(archive, longest_);
  archive(silence_, approaching_, accepted_);
  requireNumbers(silence_);
  requireLoaded(longest_.insertion >= 0.0 && longest_.rotation >= 0.0, "holds a negative length of a command");
}

void Arbiter::archive(Archive& archive)
{
  archive(silence_, accepted_);
  requireNumbers(silence_);
  if (archive.reading())
    release();
}

void HandControl::archive(Archive& archive)
{
  archive(gate_, insertion_, rotation_, mode_);
  requireIndex(static_cast<int>(mode_), 0, static_cast<int>(Mode::kFree) + 1);
  archiveMotion(archive, setpoint_.motion);
  archiveMotion(archive, slipped_);
  archive(setpoint_.pressure, is_homing_, state_.is_homed, state_.is_busy, arbiter_);
  requireFinite(setpoint_.pressure.value_or(0.0));
  std::string name = nameOf(state_.state);
  archiveText(archive, name);
  archiveText(archive, state_.reason);
  const std::optional<OperatingState> state = operatingState(name);
  requireLoaded(state && *state != OperatingState::kFault, "holds an unknown operating state");
  if (!archive.reading())
    return;
  state_.state = *state;
  requireLoaded(limits_.pressure.contains(setpoint_.pressure.value_or(limits_.pressure.low)),
                "holds a pressure beyond the limits");
  ++state_.revision;
}

}  // namespace endovascular_sim::drive
