#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drive/operating_state.h"
#include "endovascular_sim/ExpertState.h"
#include "endovascular_sim/PlayerState.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "rviz_plugin/model/contrast_monitor.h"
#include "rviz_plugin/model/motion_monitor.h"
#include "rviz_plugin/model/pressure_monitor.h"
#include "rviz_plugin/model/scene_summary.h"

namespace endovascular_sim::rviz_plugin
{

/** One mark of a verdict. */
struct VerdictMark
{
  std::string name, unit;
  double value = 0.0, limit = 0.0;
  double expert = 0.0;  ///< NaN: unknown
  bool passed = false;
};

/** Verdict on a lesson. */
struct Verdict
{
  unsigned run = 0;  ///< 0: none yet
  std::string text;
  std::string page;  ///< path of metrics.html
  bool passed = false;
  std::vector<VerdictMark> marks;
};

/** What the panel knows of a session. */
struct SessionState
{
  SceneSummary scene;   ///< without instruments before they are known
  RodStateVisual wire;  ///< without nodes
  bool has_wire = false;
  double wire_age = 0.0;                                 ///< wall time since the last state [s]
  std::string branch;                                    ///< of the foremost tip; empty: unknown
  std::map<std::string, drive::ControlState> operating;  ///< operating state of each instrument
  std::vector<double> peak_force;                        ///< largest axial force on each hand in this run [N]
  ProcedureStep step;
  bool has_step = false;
  std::string c_arm_view;             ///< to which the C-arm was last commanded; empty: none
  std::string last_error;             ///< newest error of the trainee; empty: none
  double error_age = 1e9;             ///< wall time since that error [s]
  std::vector<std::string> errors;    ///< of the diagnostics
  std::vector<std::string> warnings;  ///< of the diagnostics
  Verdict verdict;                    ///< of the last recording
  bool is_recording = false;
  unsigned run = 0;                        ///< number of the run
  std::uint64_t dead_man_stops = 0;        ///< see VelocityCommander::timeOuts()
  std::string answer;                      ///< to the last request
  std::vector<std::string> waiting;        ///< services that have not answered yet, with the time since the call
  std::string subject;                     ///< pseudonym of the trainee
  std::optional<ExpertState> expert;       ///< none before an expert is recorded
  std::optional<BloodState> blood;         ///< none in a scene without flow
  std::optional<MotionStatus> motion;      ///< none in a scene whose patient rests
  std::optional<ContrastStatus> contrast;  ///< none in a scene without contrast medium
  std::optional<PlayerState> player;       ///< of a recording that is played; none in a session

  /** Step of the procedure that is to be done, from 0; before the first message the first one. */
  std::size_t presentStep() const { return has_step && step.step_of_procedure > 0 ? step.step_of_procedure - 1U : 0U; }

  /** Operating state of an instrument; null if it is not known. */
  const drive::ControlState* operatingStateOf(std::size_t instrument) const;

  bool isProcedureDone() const
  {
    return has_step && step.outcome == ProcedureStep::DONE && step.step_of_procedure == step.steps_of_procedure;
  }
};

/** Replaces what a session accumulates by what the player of its recording knows of the shown time: largest forces,
 *  newest error, view of the C-arm. A step of the procedure that begins later is forgotten.
 *  @pre the state has a player */
void takeOverPlayer(SessionState& state);

/** Texts of the panel for one instrument. Invalid or missing values are a dash. */
struct PanelTexts
{
  std::string insertion, rotation, force, torque, pressure, balloon, time, branch, step, hint, status, recording;
  std::string reason;  ///< of the status; empty: none
  int gauge = 0;       ///< share of the force limit [%], 0 to 100
  int peak = 0;        ///< largest share of this run [%], 0 to 100
};

/** @param instrument index of the chosen instrument */
PanelTexts panelTexts(const SessionState& state, std::size_t instrument);

}  // namespace endovascular_sim::rviz_plugin
