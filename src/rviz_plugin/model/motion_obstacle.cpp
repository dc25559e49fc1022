#include "rviz_plugin/model/motion_obstacle.h"

#include <algorithm>
#include <cmath>

#include "common/text/format.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kAtStop = 1e-3;   // distance from a stop [m]
constexpr double kAtLimit = 0.98;  // share of a limit of the grip at which it slips

double at(const std::vector<double>& values, std::size_t index)
{
  return index < values.size() ? values[index] : std::nan("");
}

/** Name of an instrument in the introducer that does not fit together with another one; empty without one. */
std::string instrumentInTheWay(const SessionState& state, const InstrumentSummary& of)
{
  for (std::size_t k = 0; k < state.scene.instruments.size(); ++k)
  {
    const InstrumentSummary& other = state.scene.instruments[k];
    const std::string& name = other.shape.name;
    if (at(state.wire.insertion, k) > other.outside_insertion + kAtStop &&
        std::find(of.conflicts.begin(), of.conflicts.end(), name) != of.conflicts.end())
      return name;
  }
  return {};
}

std::string obstacleOfInsertion(const SessionState& state, const InstrumentSummary& summary, double insertion,
                                double push)
{
  if (insertion < 0.0)
  {
    const std::string other = instrumentInTheWay(state, summary);
    if (!other.empty())
      return "waits outside: " + other + " is in the way; pull it out first";
    if (push < 0.0 && insertion <= summary.outside_insertion + kAtStop)
      return "is out completely";
  }
  if (push > 0.0 && summary.largest_insertion > 0.0 && insertion >= summary.largest_insertion - kAtStop)
    return formatted("end of its length: %.0f mm are in", 1e3 * insertion);
  return {};
}

/** @param unit factor to the displayed unit, with its name */
std::string obstacleOfGrip(double load, double limit, double unit, const char* format, const char* remedy)
{
  if (!(limit > 0.0) || !(std::abs(load) >= kAtLimit * limit))
    return {};
  return formatted(format, unit * limit) + remedy;
}

/** Advice for an instrument whose insertion is held: against the motion, or against the force without one. */
const char* remedyOfSlip(double push, double force)
{
  return push > 0.0 || (push == 0.0 && force > 0.0) ? "it is held; pull back" : "it is held; push or twist";
}

/** Reason of the operating state, in words for the trainee. */
std::string reasonFor(const std::string& reason, double push, double force)
{
  if (reason.rfind("the grip slips in the insertion", 0) == 0)
    return std::string("slips: ") + remedyOfSlip(push, force);
  if (reason.rfind("the grip slips in the rotation", 0) == 0)
    return "slips: its rotation is held; turn back";
  return reason;
}

}  // namespace

std::string motionObstacle(const SessionState& state, std::size_t instrument, double push)
{
  if (instrument >= state.scene.instruments.size() || !state.has_wire)
    return {};
  const InstrumentSummary& summary = state.scene.instruments[instrument];
  if (!summary.takes_commands)
    return "driven by the scene";
  const drive::ControlState* operating = state.operatingStateOf(instrument);
  if (operating != nullptr && operating->state != drive::OperatingState::kEnabled)
    return operating->reason.empty() ? "the simulation is paused; press Start" : "paused: " + operating->reason;
  const std::string stop = obstacleOfInsertion(state, summary, at(state.wire.insertion, instrument), push);
  if (!stop.empty())
    return stop;
  const double force = at(state.wire.hand_force, instrument);
  const std::string slip =
      obstacleOfGrip(force, summary.force_limit, 1.0, "slips at %g N: ", remedyOfSlip(push, force));
  if (!slip.empty())
    return slip;
  const std::string turn = obstacleOfGrip(at(state.wire.hand_torque, instrument), summary.torque_limit, 1e3,
                                          "slips at %g mN·m: ", "its rotation is held; turn back");
  if (!turn.empty())
    return turn;
  return operating != nullptr ? reasonFor(operating->reason, push, force) : std::string();
}

}  // namespace endovascular_sim::rviz_plugin
