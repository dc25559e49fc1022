#include <gtest/gtest.h>

#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kScene =
    "vessel: {friction: 0.1, tube: {radius: 0.01, pieces: [{length: 0.3}]}}\n"
    "instruments:\n"
    "  - {instrument: {use: guidewire_014_workhorse, name: wire}, drive: {source: procedure}}\n"
    "  - {instrument: {use: balloon_250_15, name: balloon}, drive: {source: procedure, initial_insertion: -0.1}}\n";

Scene sceneOf(const std::string& step)
{
  return parseScene(kScene + "procedure:\n  steps:\n    - " + step + "\n", "scene.yaml");
}

std::string refusalOf(const std::string& step)
{
  return inputErrorOf([&] { sceneOf(step); });
}

TEST(SceneProcedure, ReadsItsSteps)
{
  const Scene scene = sceneOf(
      "{phase: Entry, advance: wire, until: {tip_in: tube, beyond: 0.05, held: 0.2}, speed: 0.03, turn_speed: -1,\n"
      "       time_limit: 12, any_branch: true, retry: {back: 0.02, turn: 0.7, times: 3}}");
  const StepScene& step = scene.procedure->steps.at(0);
  EXPECT_EQ(step.phase, "Entry");
  EXPECT_EQ(step.action, StepAction::kAdvance);
  EXPECT_EQ(step.instrument, "wire");
  EXPECT_EQ(step.until.tip_in, "tube");
  EXPECT_EQ(step.until.beyond, 0.05);
  EXPECT_EQ(step.until.held, 0.2);
  EXPECT_EQ(step.speed, 0.03);
  EXPECT_EQ(step.turn_speed, -1.0);
  EXPECT_EQ(step.time_limit, 12.0);
  EXPECT_TRUE(step.any_branch);
  EXPECT_EQ(step.retry.back, 0.02);
  EXPECT_EQ(step.retry.turn, 0.7);
  EXPECT_EQ(step.retry.times, 3);
}

TEST(SceneProcedure, ReadsTheViewOfAStepAndRefusesAnUnknownOne)
{
  EXPECT_EQ(sceneOf("{wait: 1, view: spider}").procedure->steps.at(0).view, "spider");
  EXPECT_NE(refusalOf("{wait: 1, view: LAO}").find("procedure.steps.0.view (line 7): unknown view 'LAO'; known: AP"),
            std::string::npos)
      << refusalOf("{wait: 1, view: LAO}");
  EXPECT_NE(refusalOf("{wait: 1, view: CRA 70}\nfluoroscopy: {}").find("is 1.222 rad (70°), beyond the gantry"),
            std::string::npos)
      << refusalOf("{wait: 1, view: CRA 70}\nfluoroscopy: {}");
}

TEST(SceneProcedure, IsUnchangedByItsResolvedText)
{
  for (const char* step :
       {"{advance: wire, until: {tip_in: tube}}", "{withdraw: wire, until: {by: 0.1}, phase: Out}",
        "{rotate: wire, until: {turned: -2}}", "{inflate: balloon, pressure: -0.5e5, for: 3}",
        "{wait: 1.5, view: LAO 40}", "{exchange: wire, for: balloon, until: {balloon_in: tube, beyond: 0.02}}"})
  {
    const Scene scene = sceneOf(step);
    EXPECT_EQ(parseScene(scene.resolved_yaml, "again.yaml").resolved_yaml, scene.resolved_yaml) << step;
  }
}

TEST(SceneProcedure, CanBeASeparateFile)
{
  const Scene scene = loadScene(PROJECT_DIR "/config/scenes/pci.yaml");
  ASSERT_TRUE(scene.procedure);
  EXPECT_GT(scene.procedure->steps.size(), 5U);
  EXPECT_EQ(
      loadScene(PROJECT_DIR "/config/scenes/pci.yaml", {"procedure.steps.0.speed=0.03"}).procedure->steps[0].speed,
      0.03);
}

TEST(SceneProcedure, ReportsErrorsWithFileKeyAndRemedy)
{
  EXPECT_EQ(refusalOf("{push: wire}"),
            "scene.yaml: procedure.steps.0 (line 7): has no action; give one of advance, withdraw, rotate, inflate, "
            "exchange, wait, inject");
  EXPECT_NE(refusalOf("{advance: wire, rotate: wire, until: {by: 1}}").find("procedure.steps.0.rotate"),
            std::string::npos);
  EXPECT_NE(refusalOf("{advance: wire, until: {tip_inn: tube}}").find("tip_in"), std::string::npos);
  EXPECT_NE(refusalOf("{advance: wire}").find("procedure.steps.0.until"), std::string::npos);
  EXPECT_NE(refusalOf("{withdraw: wire, until: {tip_in: side}, steer: true}").find("procedure.steps.0.steer"),
            std::string::npos);
  EXPECT_NE(refusalOf("{advance: wire, until: {by: 0.1}, steer: true}").find("needs advance with until.tip_in"),
            std::string::npos);
  EXPECT_NE(refusalOf("{advance: wire, until: {beyond: 0.1, outside: true}}").find("requires a branch"),
            std::string::npos);
  EXPECT_NE(refusalOf("{advance: wire, until: {by: 0.1}, speed: -1}").find("procedure.steps.0.speed"),
            std::string::npos);
  EXPECT_NE(refusalOf("{advance: catheter, until: {by: 0.1}}").find("'catheter' is not driven"), std::string::npos);
  EXPECT_NE(refusalOf("{inflate: wire, pressure: 1e5, for: 1}").find("has no balloon"), std::string::npos);
  EXPECT_NE(refusalOf("{inflate: balloon, for: 1}").find("procedure.steps.0.pressure"), std::string::npos);
  EXPECT_NE(refusalOf("{wait: 1, speed: 2}").find("speed"), std::string::npos);
}

TEST(SceneProcedure, IsRequiredByADriveWithSourceProcedure)
{
  const std::string message = inputErrorOf([&] { parseScene(kScene, "scene.yaml"); });
  EXPECT_EQ(message,
            "scene.yaml: instruments.0.drive.source (line 3): is procedure, but the scene has no procedure; give "
            "procedure: FILE, or another source");
}

TEST(SceneProcedure, OfALessonHasHintsAndPassMarksAndAPersonWhoDrives)
{
  for (const char* name :
       {"lesson_bifurcation", "lesson_catheter_needs_wire", "lesson_lad_stent", "lesson_pressure", "lesson_injection"})
  {
    const Scene scene = loadScene(std::string(PROJECT_DIR "/config/scenes/") + name + ".yaml");
    ASSERT_TRUE(scene.procedure.has_value()) << name;
    EXPECT_TRUE(scene.procedure->guided) << name;
    EXPECT_GT(scene.procedure->pass.time, 0.0) << name;
    for (const StepScene& step : scene.procedure->steps)
      EXPECT_NE(step.hint, "") << name;
    for (const DrivenInstrument& driven : scene.instruments)
      EXPECT_EQ(driven.drive.source, DriveSource::kTopic) << name;
    const Scene again = parseRecordedScene(scene.resolved_yaml, "recorded");
    EXPECT_TRUE(again.procedure->guided) << name;
    EXPECT_EQ(again.procedure->steps[0].hint, scene.procedure->steps[0].hint) << name;
    EXPECT_EQ(again.procedure->pass.time, scene.procedure->pass.time) << name;
  }
}

TEST(SceneProcedure, OfALessonRefusesInstrumentsThatNoPersonDrives)
{
  const std::string lesson = PROJECT_DIR "/config/scenes/lesson_bifurcation.yaml";
  const std::string message = inputErrorOf([&] { loadScene(lesson, {"drive.source=procedure"}); });
  EXPECT_NE(message.find("'wire' is not driven by a person"), std::string::npos) << message;
  EXPECT_FALSE(loadScene(lesson, {"drive.source=procedure", "procedure.guided=false"}).procedure->guided);
}

}  // namespace
}  // namespace endovascular_sim::scene
