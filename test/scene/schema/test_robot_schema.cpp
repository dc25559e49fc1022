#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kUrdf = "robots/catheter_robot.urdf";
const std::string kCarriage = "{joint: catheter_carriage, instrument: wire, motion: insertion}";

std::string sceneText(const std::string& joints, const std::string& drive = "source: topic",
                      const std::string& urdf = kUrdf)
{
  return "name: s\ninstrument: {name: wire, sections: [{length: 0.4, radius: 4e-4, young_modulus: 2.0e10, "
         "poisson_ratio: 0.3, density: 6000, material: nitinol}]}\ndrive: {" +
         drive + "}\nrobot:\n  urdf: " + urdf + "\n  joints: [" + joints + "]\n";
}

Scene sceneWith(const std::string& joints, const std::string& drive = "source: topic")
{
  return parseScene(sceneText(joints, drive), "s.yaml");
}

std::string refusalOf(const std::string& text)
{
  return inputErrorOf([&] { parseScene(text, "s.yaml"); });
}

TEST(RobotSchema, ARobotBringsItsNodeAndItsLimits)
{
  const Scene scene = sceneWith(kCarriage, "source: topic, force_limit: 3.0");
  ASSERT_TRUE(scene.robot);
  EXPECT_EQ(scene.robot->model.name, "catheter_robot");
  EXPECT_EQ(scene.robot->frame, RobotFrame::kIntroducer);
  const std::vector<std::string> nodes = requiredNodes(scene);
  EXPECT_NE(std::find(nodes.begin(), nodes.end(), "robot"), nodes.end());
  const drive::DriveLimits& limits = scene.instruments[0].drive.limits;
  EXPECT_EQ(limits.insertion, (drive::Interval{0.0, 0.3})) << "of the carriage";
  EXPECT_EQ(limits.speed, 0.1);
  EXPECT_EQ(limits.force, 3.0) << "less than the carriage's 8 N";
}

TEST(RobotSchema, TheResolvedTextHasTheLimitsAndNeedsNoUrdf)
{
  const Scene scene = sceneWith(kCarriage);
  const Scene recorded = parseRecordedScene(scene.resolved_yaml, "recorded.yaml");
  EXPECT_TRUE(recorded.robot->model.joints.empty());
  EXPECT_EQ(recorded.robot->joints.size(), 1U);
  EXPECT_EQ(recorded.instruments[0].drive.limits, scene.instruments[0].drive.limits);
  EXPECT_EQ(recorded.resolved_yaml, scene.resolved_yaml);
  EXPECT_EQ(parseScene(scene.resolved_yaml, "again.yaml").resolved_yaml, scene.resolved_yaml);
}

TEST(RobotSchema, ASceneWithoutARobotIsUnchanged)
{
  const std::string text = sceneText(kCarriage);
  const Scene scene = parseScene(text.substr(0, text.find("robot:")), "s.yaml");
  EXPECT_FALSE(scene.robot);
  EXPECT_EQ(scene.resolved_yaml.find("robot"), std::string::npos);
  EXPECT_EQ(scene.resolved_yaml.find("limits"), std::string::npos);
}

TEST(RobotSchema, ThePoseIsThatOfTheUrdfConvention)
{
  std::string text = sceneText(kCarriage);
  text += "  pose: {frame: patient, position: [0.1, 0.2, 0.3], rpy: [0.1, 0.2, 0.3]}\n";
  const Scene scene = parseScene(text, "s.yaml");
  EXPECT_EQ(scene.robot->frame, RobotFrame::kPatient);
  const Eigen::Isometry3d pose = scene.robot->pose();
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_NEAR(pose(2, 0), -std::sin(0.2), 1e-15);
  EXPECT_NEAR(std::atan2(pose(1, 0), pose(0, 0)), 0.3, 1e-15);
  EXPECT_NEAR(std::atan2(pose(2, 1), pose(2, 2)), 0.1, 1e-15);
}

TEST(RobotSchema, TheOrderOfTheJointsIsThatOfTheScene)
{
  const Scene scene = sceneWith(
      "{joint: wire_chuck, instrument: wire, motion: rotation, ratio: -2, backlash: 0.1}, "
      "{joint: wire_roller, instrument: wire, motion: insertion, ratio: 0.02, offset: 0.01}");
  EXPECT_EQ(scene.robot->joints[0].joint, "wire_chuck");
  EXPECT_EQ(scene.robot->joints[0].motion, robot::Motion::kRotation);
  EXPECT_EQ(scene.robot->joints[0].ratio, -2.0);
  EXPECT_EQ(scene.robot->joints[0].backlash, 0.1);
  EXPECT_EQ(scene.robot->joints[1].offset, 0.01);
  EXPECT_EQ(scene.instruments[0].drive.limits.turning_speed, 24.0) << "12 rad/s of the chuck";
}

TEST(RobotSchema, WrongRobotsAreRefusedByKeyAndRemedy)
{
  const std::string chuck = "{joint: catheter_chuck, instrument: wire, motion: ";
  struct Refusal
  {
    std::string text;
    std::string key;
    std::string remedy;
  };
  const std::vector<Refusal> refusals = {
      {sceneText("{joint: cariage, instrument: wire, motion: insertion}"), "robot.joints.0.joint (line 6)",
       "has no joint 'cariage'; its movable joints are catheter_carriage"},
      {sceneText("{joint: wire_carriage, instrument: wire, motion: insertion}"), "robot.joints.0.joint", "is fixed"},
      {sceneText("{joint: wire_roller_follower, instrument: wire, motion: insertion}"), "robot.joints.0.joint",
       "mimics 'wire_roller'"},
      {sceneText("{joint: catheter_carriage, instrument: wyre, motion: insertion}"), "robot.joints.0.instrument",
       "the scene has no instrument 'wyre'; it has wire"},
      {sceneText("{joint: catheter_carriage, instrument: wire, motion: insert}"), "robot.joints.0.motion",
       "must be one of insertion, rotation, pressure"},
      {sceneText("{joint: catheter_carriage, instrument: wire}"), "robot.joints.0.motion", "missing"},
      {sceneText(chuck + "pressure}"), "robot.joints.0.motion", "has no balloon"},
      {sceneText(chuck + "rotation, ratio: 0}"), "robot.joints.0.ratio", "is 0"},
      {sceneText(chuck + "rotation, ratio: .nan}"), "robot.joints.0.ratio", "finite"},
      {sceneText(chuck + "rotation, backlash: -0.1}"), "robot.joints.0.backlash", "zero or positive"},
      {sceneText(kCarriage + ", {joint: wire_roller, instrument: wire, motion: insertion}"), "robot.joints.1.motion",
       "joint 'catheter_carriage' (robot.joints.0) already moves the insertion of 'wire'"},
      {sceneText(kCarriage + ", {joint: catheter_carriage, instrument: wire, motion: rotation}"),
       "robot.joints.1.joint", "a joint moves one instrument"},
      {sceneText(kCarriage, "source: script"), "robot.joints.0.instrument", "set drive.source: topic"},
      {sceneText(kCarriage, "source: topic, initial_insertion: 0.35"), "robot.joints.0.offset",
       "an offset of 0.35 puts it at its lower limit"},
      {sceneText(""), "robot.joints (line 6)", "expected a list"},
      {sceneText(kCarriage, "source: topic", "robots/none.urdf"), "robot.urdf (line 5)", "no such file"},
      {"name: s\ninstrument: {use: guidewire_035_j}\ndrive: {source: topic}\nrobot: {urdf: " + kUrdf + "}\n",
       "robot.joints", "missing"},
      {sceneText(kCarriage) + "  pose: {frame: world}\n", "robot.pose.frame", "one of introducer, patient"}};
  for (const Refusal& refusal : refusals)
  {
    const std::string message = refusalOf(refusal.text);
    EXPECT_EQ(message.rfind("s.yaml: " + refusal.key, 0), 0U) << message << "\nof " << refusal.text;
    EXPECT_NE(message.find(refusal.remedy), std::string::npos) << message << "\nof " << refusal.text;
  }
}

TEST(RobotSchema, JointsThatMoveNothingAreWarnedOf)
{
  const Scene scene = sceneWith(kCarriage);
  ASSERT_EQ(scene.warnings.size(), 3U) << "catheter_chuck, wire_roller, wire_chuck";
  EXPECT_NE(scene.warnings[0].find("joint 'catheter_chuck': moves no instrument"), std::string::npos);
}

TEST(RobotSchema, TheExampleIsValidWithoutAWarning)
{
  const Scene scene = loadScene(PROJECT_DIR "/config/scenes/robot.yaml");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.robot->joints.size(), 4U);
}

}  // namespace
}  // namespace endovascular_sim::scene
