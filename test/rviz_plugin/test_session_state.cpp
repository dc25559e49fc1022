#include "rviz_plugin/model/session_state.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

SessionState running()
{
  SessionState state;
  InstrumentSummary wire;
  wire.shape.name = "wire";
  wire.force_limit = 5.0;
  InstrumentSummary balloon;
  balloon.shape.name = "balloon";
  balloon.has_balloon = true;
  state.scene.instruments = {wire, balloon};
  state.has_wire = true;
  state.wire.time = 12.34;
  state.wire.insertion = {0.1234, 0.05};
  state.wire.rotation = {M_PI, 0.0};
  state.wire.hand_force = {-2.0, 0.0};
  state.wire.hand_torque = {1e-3, 0.0};
  state.wire.pressure = {0.0, 8.0 * 101325.0};
  state.branch = "left renal";
  return state;
}

TEST(PanelTexts, ShowTheChosenInstrument)
{
  const PanelTexts wire = panelTexts(running(), 0);
  EXPECT_EQ(wire.insertion, "123.4 mm");
  EXPECT_EQ(wire.rotation, "180 °");
  EXPECT_EQ(wire.force, "-2.00 N of 5.0 N");
  EXPECT_EQ(wire.gauge, 40);
  EXPECT_EQ(wire.time, "12.3 s");
  EXPECT_EQ(wire.branch, "left renal");
  EXPECT_EQ(wire.pressure, "–");
  EXPECT_EQ(wire.status, "running");
  EXPECT_EQ(panelTexts(running(), 1).pressure, "8.0 atm");
}

TEST(PanelTexts, SayThatATipIsOutside)
{
  SessionState state = running();
  state.wire.insertion[0] = -0.027;
  EXPECT_EQ(panelTexts(state, 0).insertion, "27 mm outside");
  state.wire.insertion[0] = -1e-6;
  EXPECT_EQ(panelTexts(state, 0).insertion, "0.0 mm");
}

TEST(PanelTexts, KeepThePeakOfTheForce)
{
  SessionState state = running();
  state.peak_force = {4.0};
  EXPECT_EQ(panelTexts(state, 0).gauge, 40);
  EXPECT_EQ(panelTexts(state, 0).peak, 80);
  state.wire.hand_force[0] = 4.5;
  EXPECT_EQ(panelTexts(state, 0).peak, 90) << "the present force is newer than the peak";
  EXPECT_EQ(panelTexts(state, 1).peak, 0);
}

TEST(PanelTexts, DescribeTheBalloonByItsChart)
{
  SessionState state = running();
  instrument::Balloon& balloon = state.scene.instruments[1].balloon;
  balloon.folded_diameter = 1e-3;
  balloon.compliance = {{8.0 * 101325.0, 3.0e-3}, {16.0 * 101325.0, 3.2e-3}};
  balloon.nominal_pressure = 8.0 * 101325.0;
  balloon.rated_burst_pressure = 16.0 * 101325.0;
  EXPECT_EQ(panelTexts(state, 1).pressure, "8.0 atm, ⌀ 3.00 mm");
  EXPECT_EQ(panelTexts(state, 1).balloon, "nominal 8.0 atm (⌀ 3.00 mm), rated 16.0 atm");
  EXPECT_EQ(panelTexts(state, 0).balloon, "");
}

TEST(PanelTexts, AreDashesForMissingAndInvalidValues)
{
  const PanelTexts empty = panelTexts({}, 0);
  EXPECT_EQ(empty.insertion, "–");
  EXPECT_EQ(empty.time, "–");
  EXPECT_EQ(empty.status, "waiting for the simulation");
  SessionState state = running();
  state.wire.hand_force[0] = std::nan("");
  state.wire.insertion[0] = HUGE_VAL;
  EXPECT_EQ(panelTexts(state, 0).insertion, "–");
  EXPECT_EQ(panelTexts(state, 0).gauge, 0);
  EXPECT_EQ(panelTexts(state, 99).insertion, "–");
}

TEST(PanelTexts, NameAPauseAndItsReason)
{
  SessionState state = running();
  state.operating["wire"] = {drive::OperatingState::kPaused, true, false, "the contact node does not respond", 0};
  EXPECT_EQ(panelTexts(state, 0).status, "paused");
  EXPECT_EQ(panelTexts(state, 0).reason, "the contact node does not respond");
  EXPECT_EQ(panelTexts(state, 1).status, "running");
  state.operating["wire"] = {drive::OperatingState::kEnabled, true, false, "the grip slips in the insertion", 0};
  EXPECT_EQ(panelTexts(state, 0).status, "running") << "a word that fits beside the buttons";
  state.operating.clear();
  state.wire_age = 3.0;
  EXPECT_EQ(panelTexts(state, 0).status, "no state of the simulation");
}

TEST(PanelTexts, NameTheProcedureStepAndItsOutcome)
{
  SessionState state = running();
  EXPECT_EQ(panelTexts(state, 0).step, "no procedure");
  state.has_step = true;
  state.step.begun = 3;
  state.step.phase = "access";
  state.step.name = "advance soft_wire until its tip is in left_main";
  EXPECT_EQ(panelTexts(state, 0).step, "3: access, advance soft wire until its tip is in left main")
      << "as the picture";
  state.step.name = "advance the wire";
  state.step.outcome = ProcedureStep::FAILED;
  state.step.failure = "no progress";
  EXPECT_EQ(panelTexts(state, 0).step, "3: access, advance the wire (failed: no progress)");
}

TEST(PanelTexts, ShowTheHintOfTheStepAndTheEndOfALesson)
{
  SessionState state;
  EXPECT_EQ(panelTexts(state, 0).hint, "");
  state.scene.steps = {{"wire", "Push the wire to the fork.", ""}, {"wire", "Push the wire.", ""}};
  EXPECT_EQ(panelTexts(state, 0).hint, "Push the wire to the fork.") << "the lesson begins with the first motion";
  EXPECT_EQ(panelTexts(state, 0).step, "1 of 2: begins with a motion");
  EXPECT_EQ(state.presentStep(), 0U);
  state.has_step = true;
  state.step.phase = "To the fork";
  state.step.name = "advance wire";
  state.step.hint = "Push the wire.";
  state.step.step_of_procedure = 2;
  state.step.steps_of_procedure = 4;
  EXPECT_EQ(panelTexts(state, 0).step, "2 of 4: To the fork, advance wire");
  EXPECT_EQ(state.presentStep(), 1U);
  EXPECT_EQ(panelTexts(state, 0).hint, "Push the wire.");
  state.step.outcome = ProcedureStep::DONE;
  EXPECT_EQ(panelTexts(state, 0).hint, "") << "the next step begins at once";
  state.step.step_of_procedure = 4;
  state.is_recording = true;
  EXPECT_EQ(panelTexts(state, 0).hint, "All steps are done.");
}

TEST(StateOfARecording, IsThatOfTheShownTime)
{
  SessionState state = running();
  state.peak_force = {9.0, 9.0};
  state.c_arm_view = "AP";
  state.is_recording = true;
  state.has_step = true;
  state.step.begin = 15.0;
  PlayerState player;
  player.time = 12.0;
  player.peak_hand_force = {2.5, 0.0};
  player.c_arm_view = "LAO 40";
  for (const double time : {3.0, 10.0, 14.0})
  {
    PlayerChapter error;
    error.kind = PlayerChapter::ERROR;
    error.time = time;
    error.name = "at " + std::to_string(static_cast<int>(time)) + " s";
    player.chapters.push_back(error);
  }
  state.player = player;
  takeOverPlayer(state);
  EXPECT_EQ(state.peak_force, player.peak_hand_force);
  EXPECT_EQ(state.c_arm_view, "LAO 40");
  EXPECT_EQ(state.last_error, "Error: at 10 s");
  EXPECT_NEAR(state.error_age, 2.0, 1e-12);
  EXPECT_FALSE(state.has_step) << "it begins later";
  EXPECT_FALSE(state.is_recording);
  state.player->time = 1.0;
  takeOverPlayer(state);
  EXPECT_EQ(state.last_error, "");
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
