#include "rviz_plugin/model/session_state.h"

#include <algorithm>
#include <cmath>

#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kStateAge = 1.0;  ///< wall time after which the last state is old [s]
const char* const kDash = "–";

/** Number in a unit; a dash for a value that is not finite. */
std::string number(double value, int decimals, const char* unit)
{
  if (!std::isfinite(value) || std::abs(value) > 1e9)
    return kDash;
  return formatted("%.*f %s", decimals, value, unit);
}

double at(const std::vector<double>& values, std::size_t index)
{
  return index < values.size() ? values[index] : std::nan("");
}

/** Length beyond the introducer; before it the tip is outside. */
std::string insertionText(double insertion)
{
  const double length = 1e3 * insertion;
  return length <= -0.5 ? number(-length, 0, "mm outside") : number(std::abs(length) < 0.05 ? 0.0 : length, 1, "mm");
}

/** Text with the names of branches and instruments as the picture shows them. */
std::string withBlanks(std::string text)
{
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string stepText(const SessionState& state)
{
  if (!state.has_step)
    return state.scene.steps.empty() ? "no procedure"
                                     : "1 of " + std::to_string(state.scene.steps.size()) + ": begins with a motion";
  const ProcedureStep& step = state.step;
  std::string text = step.steps_of_procedure > 0
                         ? std::to_string(step.step_of_procedure) + " of " + std::to_string(step.steps_of_procedure)
                         : std::to_string(step.begun);
  text += ": " + step.phase + ", " + withBlanks(step.name);
  if (step.outcome == ProcedureStep::DONE)
    text += " (done)";
  else if (step.outcome == ProcedureStep::FAILED)
    text += " (failed: " + withBlanks(step.failure) + ")";
  else if (step.outcome == ProcedureStep::LOST)
    text += " (repeated)";
  if (step.wrong_branches > 0)
    text += "; wrong branches: " + std::to_string(step.wrong_branches);
  return text;
}

std::string hintText(const SessionState& state)
{
  if (!state.has_step)
    return state.scene.steps.empty() ? "" : state.scene.steps.front().hint;
  if (state.isProcedureDone())
    return "All steps are done.";
  return state.step.outcome == ProcedureStep::RUNNING ? state.step.hint : "";
}

const char* wordOf(drive::OperatingState state)
{
  switch (state)
  {
    case drive::OperatingState::kDisabled:
      return "disabled";
    case drive::OperatingState::kPaused:
      return "paused";
    case drive::OperatingState::kFault:
      return "fault";
    case drive::OperatingState::kEnabled:
      break;
  }
  return "running";
}

std::string statusText(const SessionState& state, std::size_t instrument)
{
  if (!state.has_wire)
    return "waiting for the simulation";
  const drive::ControlState* operating = state.operatingStateOf(instrument);
  const bool is_old = state.wire_age > kStateAge;
  if (operating == nullptr || (operating->state == drive::OperatingState::kEnabled && is_old))
    return is_old ? "no state of the simulation" : "running";
  return wordOf(operating->state);
}

/** Share of a limit [%]; 0 for a value that is not finite. */
int shareOf(double value, double limit)
{
  return std::isfinite(value) ? static_cast<int>(std::lround(100.0 * std::min(std::abs(value) / limit, 1.0))) : 0;
}

void describeBalloon(const InstrumentSummary& summary, double pressure, PanelTexts& texts)
{
  texts.pressure = number(pressure / units::kAtmosphere, 1, "atm");
  const instrument::Balloon& balloon = summary.balloon;
  if (balloon.compliance.empty() || !std::isfinite(pressure))
    return;
  texts.pressure += formatted(", ⌀ %.2f mm", 1e3 * balloon.diameterAt(pressure));
  texts.balloon =
      formatted("nominal %.1f atm (⌀ %.2f mm), rated %.1f atm", balloon.nominal_pressure / units::kAtmosphere,
                1e3 * balloon.nominalDiameter(), balloon.rated_burst_pressure / units::kAtmosphere);
}

}  // namespace

const drive::ControlState* SessionState::operatingStateOf(std::size_t instrument) const
{
  if (instrument >= scene.instruments.size())
    return nullptr;
  const auto found = operating.find(scene.instruments[instrument].shape.name);
  return found == operating.end() ? nullptr : &found->second;
}

void takeOverPlayer(SessionState& state)
{
  const PlayerState& player = *state.player;
  state.is_recording = false;
  state.peak_force = player.peak_hand_force;
  state.c_arm_view = player.c_arm_view;
  state.last_error.clear();
  state.error_age = 1e9;
  for (const PlayerChapter& chapter : player.chapters)
    if (chapter.kind == PlayerChapter::ERROR && chapter.time <= player.time)
    {
      state.last_error = "Error: " + chapter.name;
      state.error_age = player.time - chapter.time;
    }
  if (state.has_step && state.step.begin > player.time)
  {
    state.has_step = false;
    state.step = ProcedureStep();
  }
}

PanelTexts panelTexts(const SessionState& state, std::size_t instrument)
{
  PanelTexts texts;
  const RodStateVisual& wire = state.wire;
  const double force = at(wire.hand_force, instrument);
  texts.insertion = insertionText(at(wire.insertion, instrument));
  texts.rotation = number(at(wire.rotation, instrument) / units::kDegree, 0, "°");
  texts.force = number(force, 2, "N");
  texts.torque = number(1e3 * at(wire.hand_torque, instrument), 2, "mN·m");
  texts.time = number(state.has_wire ? wire.time : std::nan(""), 1, "s");
  texts.pressure = kDash;
  if (instrument < state.scene.instruments.size())
  {
    const InstrumentSummary& summary = state.scene.instruments[instrument];
    if (summary.force_limit > 0.0)
    {
      texts.force += " of " + number(summary.force_limit, 1, "N");
      texts.gauge = shareOf(force, summary.force_limit);
      texts.peak = std::max(texts.gauge, shareOf(at(state.peak_force, instrument), summary.force_limit));
    }
    if (summary.has_balloon)
      describeBalloon(summary, at(wire.pressure, instrument), texts);
  }
  texts.branch = state.branch.empty() ? kDash : state.branch;
  texts.step = stepText(state);
  texts.hint = hintText(state);
  texts.status = statusText(state, instrument);
  if (const drive::ControlState* operating = state.operatingStateOf(instrument))
    texts.reason = operating->reason;
  texts.recording = state.is_recording ? "recording, run " + std::to_string(state.run) : "not recording";
  return texts;
}

}  // namespace endovascular_sim::rviz_plugin
