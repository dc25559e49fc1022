#include "drive/operating_state.h"

namespace endovascular_sim::drive
{
namespace
{

// From the best to the worst one.
constexpr OperatingState kStates[] = {OperatingState::kEnabled, OperatingState::kPaused, OperatingState::kDisabled,
                                      OperatingState::kFault};

}  // namespace

const char* nameOf(OperatingState state)
{
  switch (state)
  {
    case OperatingState::kEnabled:
      return "ENABLED";
    case OperatingState::kPaused:
      return "PAUSED";
    case OperatingState::kFault:
      return "FAULT";
    case OperatingState::kDisabled:
      break;
  }
  return "DISABLED";
}

std::optional<OperatingState> operatingState(const std::string& name)
{
  for (const OperatingState state : kStates)
    if (name == nameOf(state))
      return state;
  return std::nullopt;
}

OperatingState worse(OperatingState a, OperatingState b)
{
  OperatingState worst = OperatingState::kEnabled;
  for (const OperatingState state : kStates)
    if (state == a || state == b)
      worst = state;
  return worst;
}

}  // namespace endovascular_sim::drive
