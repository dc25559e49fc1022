#include <string>

#include <gtest/gtest.h>

#include "common/error.h"
#include "scene/scene_file.h"

namespace endovascular_sim::scene
{
namespace
{

std::string sceneText(const std::string& drive)
{
  return "name: s\ninstrument: {name: wire, sections: [{length: 0.4, radius: 4e-4, young_modulus: 2.0e10, "
         "poisson_ratio: "
         "0.3, density: 6000, material: nitinol}]}\ndrive: {source: topic" +
         drive + "}\n";
}

Scene sceneWith(const std::string& drive)
{
  return parseScene(sceneText(drive), "s.yaml");
}

TEST(LimitsSchema, DefaultsAreTheGripAndTheLengthOfTheInstrument)
{
  const DrivenInstrument driven = sceneWith(", force_limit: 2.0").instruments[0];
  EXPECT_EQ(driven.drive.grip, drive::Grip::kFingers);
  EXPECT_EQ(driven.limits().insertion, (drive::Interval{-0.4, 0.4}));
  EXPECT_EQ(driven.limits().force, 2.0);
  EXPECT_EQ(driven.limits().speed, 1.0);
}

TEST(LimitsSchema, DefaultsChangeNoTextAndNoHash)
{
  const Scene scene = sceneWith("");
  EXPECT_EQ(scene.resolved_yaml.find("limits"), std::string::npos);
  EXPECT_EQ(scene.resolved_yaml.find("grip"), std::string::npos);
}

TEST(LimitsSchema, ValuesSurviveTheResolvedText)
{
  const Scene scene = sceneWith(
      ", grip: chuck, limits: {beyond: clamp, insertion: [0, 0.3], rotation: [-50, 50], speed: 0.2, acceleration: 1, "
      "turning_speed: 20, turning_acceleration: 100, step: 0.005, turn: 1, approach_speed: 0.05, "
      "approach_turning_speed: 2, force: 0.5, torque: 0.004, force_gain: 0.01, torque_gain: 500, time_out: 0.1}");
  const DriveScene& drive = parseScene(scene.resolved_yaml, "resolved.yaml").instruments[0].drive;
  EXPECT_EQ(drive.grip, drive::Grip::kChuck);
  EXPECT_TRUE(drive.limits == scene.instruments[0].drive.limits);
  EXPECT_TRUE(drive.limits != drive::DriveLimits());
  EXPECT_EQ(drive.limits.beyond, drive::BeyondLimit::kClamp);
  EXPECT_EQ(drive.limits.insertion, (drive::Interval{0.0, 0.3}));
  EXPECT_EQ(drive.limits.torque, 0.004);
}

TEST(LimitsSchema, RefusesWrongLimitsByTheirKeys)
{
  EXPECT_THROW(sceneWith(", limits: {insertion: [0.3, 0]}"), InputError);
  EXPECT_THROW(sceneWith(", initial_insertion: 0.2, limits: {insertion: [0, 0.1]}"), InputError);
  EXPECT_THROW(sceneWith(", limits: {pressure: [0, 1e6]}"), InputError) << "without a balloon";
  EXPECT_THROW(sceneWith(", limits: {speed: 0}"), InputError);
  EXPECT_THROW(sceneWith(", limits: {time_out: -1}"), InputError);
  EXPECT_THROW(sceneWith(", limits: {velocity: 1}"), InputError);
  EXPECT_THROW(sceneWith(", grip: claw"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::scene
