#include <gtest/gtest.h>

#include <cmath>

#include "common/units.h"
#include "scene/scene_file.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

using units::kDegree;

Scene sceneOf(const std::string& fluoroscopy)
{
  return parseScene("instrument: {use: guidewire_035_j, name: wire}\nfluoroscopy: {" + fluoroscopy + "}\n",
                    "scene.yaml");
}

std::string refusalOf(const std::string& fluoroscopy)
{
  return inputErrorOf([&] { sceneOf(fluoroscopy); });
}

void expectRefusal(const std::string& fluoroscopy, std::initializer_list<const char*> parts)
{
  const std::string text = refusalOf(fluoroscopy);
  for (const char* part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is missing in: " << text;
}

TEST(GantrySchema, AViewSetsTheAngles)
{
  const FluoroscopyScene scene = *sceneOf("view: RAO 30 CAU 20").fluoroscopy;
  EXPECT_NEAR(scene.primary_angle, -30.0 * kDegree, 1e-15);
  EXPECT_NEAR(scene.secondary_angle, -20.0 * kDegree, 1e-15);
  EXPECT_EQ(scene.pose().primary_angle, scene.primary_angle);
}

TEST(GantrySchema, AnUnknownViewGetsTheListOfKnownOnes)
{
  expectRefusal("view: LOA 40", {"fluoroscopy.view (line 2)", "unknown view 'LOA 40'", "spider"});
}

TEST(GantrySchema, AViewConflictsWithAngles)
{
  expectRefusal("view: AP, primary_angle: 0.1", {"fluoroscopy.primary_angle", "conflicts with view"});
}

TEST(GantrySchema, TheInitialPoseLiesWithinTheLimits)
{
  expectRefusal("primary_angle: 2.2", {"fluoroscopy.primary_angle (line 2)", "126.1°", "-120°", "fluoroscopy.gantry"});
  expectRefusal("secondary_angle: -1.0", {"fluoroscopy.secondary_angle (line 2)", "55°"});
  expectRefusal("view: CRA 60", {"fluoroscopy.view (line 2)", "60°", "55°"});
  expectRefusal("source_to_detector: 1.4", {"fluoroscopy.source_to_detector (line 2)", "0.9 and 1.3 m"});
  expectRefusal("source_to_patient: 0.5", {"fluoroscopy.source_to_patient (line 2)", "0.6 and 0.9 m"});
  expectRefusal("source_to_detector: 0.9, source_to_patient: 0.8",
                {"fluoroscopy.source_to_patient (line 2)", "touches the patient"});
}

TEST(GantrySchema, TheLimitsAreKeysOfTheScene)
{
  const FluoroscopyScene scene =
      *sceneOf(
           "primary_angle: 2.5, source_to_detector: 1.5, gantry: {primary_limit: 3, source_to_detector: [1, 1.6], "
           "angular_speed: 0.5, table_stroke: [0.1, 0, 1], table_speed: 0.1}")
           .fluoroscopy;
  EXPECT_EQ(scene.gantry.primary, 3.0);
  EXPECT_EQ(scene.gantry.source_to_detector.max, 1.6);
  EXPECT_EQ(scene.gantry.angular_speed, 0.5);
  EXPECT_EQ(scene.gantry.table_stroke, Eigen::Vector3d(0.1, 0.0, 1.0));
  EXPECT_EQ(scene.gantry.secondary, fluoroscopy::GantryLimits().secondary);
}

TEST(GantrySchema, RefusesLimitsWithoutMeaning)
{
  expectRefusal("gantry: {source_to_detector: [1.3, 0.9]}", {"fluoroscopy.gantry.source_to_detector", "[smallest"});
  expectRefusal("gantry: {table_stroke: [0.1, -0.1, 1]}", {"fluoroscopy.gantry.table_stroke", "negative"});
  expectRefusal("gantry: {angular_speed: 0}", {"fluoroscopy.gantry.angular_speed", "positive"});
  expectRefusal("gantry: {angular_speed: 25}", {"fluoroscopy.gantry.angular_speed", "25 deg/s"});
  expectRefusal("gantry: {table_speed: .nan}", {"fluoroscopy.gantry.table_speed"});
  expectRefusal("gantry: {speed: 1}", {"fluoroscopy.gantry.speed", "unknown"});
}

TEST(GantrySchema, TheFieldOfTheCollimatorLiesOnTheDetector)
{
  EXPECT_EQ(sceneOf("field: [0.1, 0.2]").fluoroscopy->pose().field_width, 0.1);
  EXPECT_EQ(sceneOf("field: [0.1, 0.2]").fluoroscopy->pose().field_height, 0.2);
  expectRefusal("field: [0.1, 0.31]", {"fluoroscopy.field (line 2)", "detector_width"});
  expectRefusal("field: [-0.1, 0.1]", {"fluoroscopy.field (line 2)", "detector_width"});
}

TEST(GantrySchema, IsUnchangedByTheResolvedText)
{
  for (const char* text : {"view: spider", "field: [0, 0.1]", "primary_angle: 0.1", "gantry: {table_speed: 0.2}", ""})
  {
    const Scene scene = sceneOf(text);
    const Scene again = parseScene(scene.resolved_yaml, "resolved");
    EXPECT_EQ(again.resolved_yaml, scene.resolved_yaml);
    EXPECT_EQ(again.fluoroscopy->primary_angle, scene.fluoroscopy->primary_angle);
    EXPECT_EQ(again.fluoroscopy->gantry, scene.fluoroscopy->gantry);
  }
  EXPECT_EQ(sceneOf("").resolved_yaml.find("gantry"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::scene
