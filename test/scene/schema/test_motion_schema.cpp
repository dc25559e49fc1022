#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

/** Text of a scene with a vessel and more lines. */
std::string sceneText(const std::string& rest, const std::string& drive = "{source: topic}")
{
  return "name: s\nvessel: {anatomy: natural, friction: 0.05}\nentry: {centreline_end: right_common_femoral}\n"
         "instrument: {name: wire, sections: [{length: 0.4, radius: 4e-4, young_modulus: 2.0e10, poisson_ratio: 0.3,"
         " density: 6000, material: nitinol}]}\ndrive: " +
         drive + "\n" + rest + "\n";
}

std::string refusalOf(const std::string& text)
{
  return inputErrorOf([&] { parseScene(text, "s.yaml"); });
}

void expectRefusal(const std::string& text, const std::string& key, const std::string& remedy)
{
  const std::string message = refusalOf(text);
  EXPECT_NE(message.find("s.yaml: " + key), std::string::npos) << text << "\n" << message;
  EXPECT_NE(message.find(remedy), std::string::npos) << text << "\n" << message;
}

TEST(MotionSchema, AWordNamesThePatient)
{
  const Scene scene = parseScene(sceneText("motion: adult"), "s.yaml");
  ASSERT_TRUE(scene.motion.has_value());
  EXPECT_EQ(scene.motion->patient.heart.base_displacement, 0.012);
  EXPECT_EQ(scene.motion->patient.region.fixed.size(), 3U);
  EXPECT_EQ(scene.motion->heart_rate, 1.1667);
  EXPECT_EQ(scene.motion->breathing_rate, 0.25);
  EXPECT_FALSE(scene.motion->breath_held);
}

TEST(MotionSchema, TheTextOfASceneHoldsThePatient)
{
  const Scene scene = parseScene(
      sceneText("motion: {patient: adult, heart_rate: 90 1/min, breathing_rate: 0.3, breath_held: true}"), "s.yaml");
  EXPECT_NE(scene.resolved_yaml.find("      base_displacement: 0.012\n"), std::string::npos) << scene.resolved_yaml;
  const Scene recorded = parseRecordedScene(scene.resolved_yaml, "a bag");
  ASSERT_TRUE(recorded.motion.has_value());
  EXPECT_EQ(recorded.resolved_yaml, scene.resolved_yaml);
  EXPECT_EQ(recorded.motion->heart_rate, 1.5);
  EXPECT_EQ(recorded.motion->breathing_rate, 0.3);
  EXPECT_TRUE(recorded.motion->breath_held);
  EXPECT_EQ(recorded.motion->patient.heart.relaxation, scene.motion->patient.heart.relaxation);
}

TEST(MotionSchema, AmplitudesOfAPatientAreKeysOfTheScene)
{
  const Scene scene = parseScene(sceneText("motion: adult"), "s.yaml", {"motion.patient.heart.apex_rotation=0.1"});
  EXPECT_EQ(scene.motion->patient.heart.apex_rotation, 0.1);
  EXPECT_EQ(scene.motion->patient.heart.base_rotation, -0.052);
}

TEST(MotionSchema, OtherScenesKeepTheirTextsAndHashes)
{
  const Scene still = parseScene(sceneText(""), "s.yaml");
  const Scene none = parseScene(sceneText("motion: none"), "s.yaml");
  const Scene moving = parseScene(sceneText("motion: adult"), "s.yaml");
  EXPECT_FALSE(still.motion.has_value());
  EXPECT_EQ(still.resolved_yaml.find("motion"), std::string::npos);
  EXPECT_EQ(none.resolved_yaml, still.resolved_yaml);
  EXPECT_NE(moving.motionHash(), still.motionHash());
  EXPECT_EQ(centrelineUse(still), CentrelineUse::kIfCheap);
  EXPECT_EQ(centrelineUse(moving), CentrelineUse::kRequired);
}

TEST(MotionSchema, TheFlowDrivesTheHeart)
{
  const Scene scene = parseScene(sceneText("flow: {circulation: adult, heart_rate: 1.5}\nmotion: adult"), "s.yaml");
  EXPECT_EQ(scene.motion->heart_rate, 1.5);
  const Scene faster = parseScene(scene.resolved_yaml, "s.yaml", {"flow.heart_rate=2.0"});
  EXPECT_EQ(faster.motion->heart_rate, 2.0);
  expectRefusal(sceneText("flow: adult\nmotion: {patient: adult, heart_rate: 2.0}"), "motion.heart_rate (line 7)",
                "drives the heart; remove it, and set flow.heart_rate");
}

TEST(MotionSchema, OnlyWiresBehindAnIntroducerMove)
{
  const std::string moving = "motion: adult";
  expectRefusal(sceneText(moving + "\nintroducer: false\nproximal_end: clamped", "{source: none}"), "motion (line 6)",
                "set introducer: true");
  expectRefusal(sceneText(moving + "\nsolver: {scheme: paper}"), "solver.scheme (line 7)", "set solver.scheme: kkt");
  std::string bench = sceneText(moving + "\nrollers: [{position: [0, 1, 0], radius: 0.01}]");
  bench.erase(bench.find("vessel"), bench.find("instrument") - bench.find("vessel"));
  expectRefusal(bench, "motion (line 4)", "remove motion, or the rollers");
}

TEST(MotionSchema, AWaitMayNameTheBreathAndTheHeart)
{
  const std::string steps =
      "\nprocedure: {steps: [{wait: 0.5, breath: hold, until: diastole}, {wait: 0, breath: free}]}";
  const Scene scene = parseScene(sceneText("motion: adult" + steps), "s.yaml");
  const std::vector<StepScene>& waits = scene.procedure->steps;
  EXPECT_EQ(waits[0].breath_held, true);
  EXPECT_TRUE(waits[0].until_diastole);
  EXPECT_EQ(waits[1].breath_held, false);
  EXPECT_FALSE(waits[1].until_diastole);
  EXPECT_EQ(parseRecordedScene(scene.resolved_yaml, "a bag").resolved_yaml, scene.resolved_yaml);
  EXPECT_TRUE(parseScene(sceneText("motion: none" + steps), "s.yaml").procedure->steps[0].until_diastole);
  expectRefusal(sceneText("motion: adult\nprocedure: {steps: [{wait: 1, breath: deep}]}"), "procedure.steps.0.breath",
                "must be one of hold, free");
}

}  // namespace
}  // namespace endovascular_sim::scene
