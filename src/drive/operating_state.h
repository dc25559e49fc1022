#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace endovascular_sim::drive
{

/** Operating state of an instrument, a robot or a haptic device, as CRTK defines it. The haptic protocol sends these
 * numbers. */
enum class OperatingState : std::uint8_t
{
  kDisabled = 0,
  kEnabled = 1,
  kPaused = 2,
  kFault = 3,
};

/** CRTK name of a state, e.g. "ENABLED". */
const char* nameOf(OperatingState state);

/** State with a CRTK name; none for another text. */
std::optional<OperatingState> operatingState(const std::string& name);

/** The worse one of two states: fault, disabled, paused, enabled. */
OperatingState worse(OperatingState a, OperatingState b);

/** Operating state of an instrument or a robot with its circumstances. */
struct ControlState
{
  OperatingState state = OperatingState::kEnabled;
  bool is_homed = true;        ///< false after `unhome`, until the end of `home`
  bool is_busy = false;        ///< true during a move or homing
  std::string reason;          ///< reason of a state other than enabled, or a warning
  std::uint64_t revision = 0;  ///< incremented whenever the state is to be published, also without a change
};

}  // namespace endovascular_sim::drive
