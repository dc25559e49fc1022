#include "robot/urdf/urdf_reader.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::robot
{
namespace
{

/** URDF of a rail with one joint and further elements. */
std::string urdfWith(const std::string& joint, const std::string& more = "")
{
  return "<robot name=\"r\">\n<link name=\"base\"/>\n<link name=\"carriage\"/>\n" + joint + "\n" + more +
         "\n</robot>\n";
}

std::string slide(const std::string& inside, const std::string& name = "slide", const std::string& child = "carriage",
                  const std::string& type = "prismatic")
{
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"base\"/><child link=\"" + child + "\"/>" +
         inside + "</joint>";
}

const std::string kLimit = "<limit lower=\"0\" upper=\"0.3\" velocity=\"0.1\" effort=\"5\"/>";
const std::string kAxis = "<axis xyz=\"1 0 0\"/>";
const std::string kSlide = slide(kAxis + kLimit);
const std::string kWheel = "<link name=\"wheel\"/>\n";

std::string refusalOf(const std::string& urdf)
{
  return inputErrorOf([&] { parseUrdf(urdf, "r.urdf"); });
}

struct Refusal
{
  std::string urdf;
  std::string joint;   ///< joint or line
  std::string remedy;  ///< words of the remedy
};

TEST(UrdfReader, ReadsJointsWithTheirLimitsInTheOrderOfTheFile)
{
  const RobotModel model =
      parseUrdf(urdfWith(kSlide, kWheel + slide("<mimic joint=\"slide\" multiplier=\"-2\" offset=\"0.5\"/>", "roller",
                                                "wheel", "continuous")),
                "r.urdf");
  EXPECT_EQ(model.name, "r");
  EXPECT_EQ(model.root_link, "base");
  ASSERT_EQ(model.joints.size(), 2U);
  const Joint& joint = *model.find("slide");
  EXPECT_EQ(joint.kind, JointKind::kPrismatic);
  EXPECT_EQ(joint.line, 4);
  EXPECT_EQ(joint.range, (drive::Interval{0.0, 0.3}));
  EXPECT_EQ(joint.speed, 0.1);
  EXPECT_EQ(joint.effort, 5.0);
  const Joint& roller = *model.find("roller");
  EXPECT_FALSE(roller.range) << "a continuous joint has no range";
  EXPECT_FALSE(roller.speed) << "without <limit> there is no limit";
  EXPECT_EQ(roller.mimic->joint, "slide");
  EXPECT_EQ(roller.mimic->multiplier, -2.0);
  EXPECT_EQ(roller.mimic->offset, 0.5);
  EXPECT_TRUE(model.warnings.empty());
}

TEST(UrdfReader, AContinuousJointWithALimitHasNoRange)
{
  const RobotModel model = parseUrdf(
      urdfWith(slide(kAxis + "<limit velocity=\"12\" effort=\"0.05\"/>", "chuck", "carriage", "continuous")), "r.urdf");
  EXPECT_FALSE(model.joints[0].range);
  EXPECT_EQ(model.joints[0].speed, 12.0);
}

TEST(UrdfReader, RefusesWrongFilesWithJointAndRemedy)
{
  const std::string mimic_pair = kWheel + slide("<mimic joint=\"b\"/>", "a", "carriage", "continuous") + "\n" +
                                 slide("<mimic joint=\"a\"/>", "b", "wheel", "continuous");
  const std::vector<Refusal> refusals = {
      {urdfWith(slide(kAxis + "<limit lower=\"0.3\" upper=\"0\" velocity=\"0.1\" effort=\"5\"/>")),
       "joint 'slide' (line 4)", "exchange lower and upper"},
      {urdfWith(slide(kAxis + "<limit lower=\"0\" upper=\"0.3\" velocity=\"-0.1\" effort=\"5\"/>")),
       "joint 'slide' (line 4)", "give the largest speed"},
      {urdfWith(slide(kAxis + "<limit lower=\"0\" upper=\"0.3\" velocity=\"0.1\" effort=\"-5\"/>")),
       "joint 'slide' (line 4)", "give the largest force"},
      {urdfWith(slide(kAxis + kLimit + "<mimic joint=\"slied\"/>")), "joint 'slide' (line 4)",
       "mimics 'slied', which does not exist; movable joints are slide"},
      {urdfWith(slide(kAxis + kLimit + "<mimic joint=\"slide\"/>")), "joint 'slide' (line 4)", "mimics itself"},
      {"<robot name=\"r\">\n<link name=\"base\"/>\n<link name=\"carriage\"/>\n" + mimic_pair + "</robot>",
       "joint 'a' (line 5)", "ring of mimics"},
      {urdfWith(kSlide, kWheel + slide("<mimic joint=\"bolt\"/>", "roller", "wheel", "continuous") +
                            "<link name=\"l\"/>" + slide("", "bolt", "l", "fixed")),
       "joint 'roller' (line 6)", "both must be prismatic, revolute or continuous"},
      {urdfWith(slide("<axis xyz=\"0 0 0\"/>" + kLimit)), "joint 'slide' (line 4)", "axis is zero"},
      {urdfWith(slide("<axis xyz=\"1 0\"/>" + kLimit)), "joint 'slide' (line 4)", "three finite numbers"},
      {urdfWith(slide(kAxis + "<limit lower=\"0\" upper=\"nan\" velocity=\"0.1\" effort=\"5\"/>")),
       "joint 'slide' (line 4)", "<limit upper=\"nan\"> is not a finite number"},
      {urdfWith(slide(kAxis + "<limit lower=\"0\" upper=\"1e999\" velocity=\"0.1\" effort=\"5\"/>")),
       "joint 'slide' (line 4)", "not a finite number"},
      {urdfWith(slide(kAxis + "<limit lower=\"0\" upper=\"0.3 m\" velocity=\"0.1\" effort=\"5\"/>")),
       "joint 'slide' (line 4)", "without a unit"},
      {urdfWith(slide(kAxis)), "joint 'slide' (line 4)", "has no <limit>"},
      {urdfWith(slide(kAxis + "<limit lower=\"0\" upper=\"0.3\" effort=\"5\"/>")), "joint 'slide' (line 4)",
       "has no velocity"},
      {urdfWith(slide(kAxis + kLimit, "slide", "cariage")), "joint 'slide' (line 4)",
       "child link 'cariage' does not exist"},
      {urdfWith("<joint name=\"slide\" type=\"fixed\"><child link=\"carriage\"/></joint>"), "joint 'slide' (line 4)",
       "has no <parent link"},
      {urdfWith(kSlide, slide("", "second", "carriage", "fixed")), "joint 'second' (line 5)",
       "a link hangs on one joint"},
      {urdfWith(kSlide, kSlide), "joint 'slide' (line 5)", "names of joints must differ"},
      {urdfWith(kSlide, "<link name=\"lonely\"/>"), "link 'lonely'", "second root"},
      {urdfWith("<joint name=\"a\" type=\"fixed\"><parent link=\"base\"/><child link=\"carriage\"/></joint>",
                "<joint name=\"b\" type=\"fixed\"><parent link=\"carriage\"/><child link=\"base\"/></joint>"),
       "link 'base'", "ring of joints"},
      {urdfWith(slide(kAxis + kLimit, "slide", "carriage", "prismatik")), "r.urdf", "prismatik"},
      {urdfWith(kSlide, "<link name=\"base\"/>"), "link 'base' (line 5)", "names must differ"},
      {"<robot name=\"r\">\n<link name=\"base\">\n</robot>", "line ", "is no XML"},
      {"", "r.urdf", "; "},
      {"<sdf/>", "r.urdf", "has no element <robot>"},
      {urdfWith(kSlide, "<xacro:arm side=\"left\"/>"), "<xacro:arm> (line 5)", "expand it"},
      {urdfWith(slide(kAxis + "<origin xyz=\"${x} 0 0\"/>" + kLimit)), "<origin> (line 4)", "expand it"},
      {"<robot name=\"r\"></robot>", "r.urdf", "is no valid URDF"},
      {"<robot><link name=\"base\"/></robot>", "r.urdf", "is no valid URDF"}};
  for (const Refusal& refusal : refusals)
  {
    const std::string message = refusalOf(refusal.urdf);
    EXPECT_EQ(message.rfind("r.urdf: ", 0), 0U) << message << " of " << refusal.urdf;
    EXPECT_NE(message.find(refusal.joint), std::string::npos) << message << " of " << refusal.urdf;
    EXPECT_NE(message.find(refusal.remedy), std::string::npos) << message << " of " << refusal.urdf;
  }
}

TEST(UrdfReader, WarnsOfATransmissionWithTheKeyOfItsRatio)
{
  const RobotModel model = parseUrdf(
      urdfWith(kSlide, "<transmission name=\"t\"><joint name=\"slide\"/><actuator name=\"m\"/></transmission>"),
      "r.urdf");
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_EQ(model.warnings[0],
            "r.urdf: transmission 't' (line 5): has no effect; give the ratio of its joint in the scene, "
            "robot.joints.N.ratio");
}

TEST(UrdfReader, WarnsOfAMeshThatDoesNotExist)
{
  const std::string visual = "<link name=\"l\"><visual><geometry><mesh filename=\"";
  const std::string end = "\"/></geometry></visual></link>" + slide("", "j", "l", "fixed");
  const auto warningsOf = [&](const std::string& mesh)
  { return parseUrdf(urdfWith(kSlide, visual + mesh + end), "r.urdf").warnings; };
  ASSERT_EQ(warningsOf("file:///nowhere/a.stl").size(), 1U);
  EXPECT_NE(warningsOf("file:///nowhere/a.stl")[0].find("there is no file /nowhere/a.stl"), std::string::npos);
  EXPECT_NE(warningsOf("a.stl").at(0).find("is no URL"), std::string::npos);
}

TEST(UrdfReader, WarnsOfAMeshInAPackageThatRvizWillNotFind)
{
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "packages";
  std::filesystem::create_directories(folder / "src" / "my_robot" / "meshes");
  std::ofstream(folder / "src" / "my_robot" / "package.xml") << "<package/>";
  std::ofstream(folder / "src" / "my_robot" / "meshes" / "a.stl") << "solid";
  const auto warningsOf = [&](const std::string& mesh)
  {
    return parseUrdf(urdfWith(kSlide, "<link name=\"l\"><visual><geometry><mesh filename=\"" + mesh +
                                          "\"/></geometry></visual></link>" + slide("", "j", "l", "fixed")),
                     "r.urdf")
        .warnings;
  };
  const char* before = std::getenv("ROS_PACKAGE_PATH");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("ROS_PACKAGE_PATH", folder.c_str(), 1);
  EXPECT_TRUE(warningsOf("package://my_robot/meshes/a.stl").empty());
  EXPECT_NE(warningsOf("package://my_robot/meshes/b.stl").at(0).find("my_robot/meshes/b.stl, so that rviz"),
            std::string::npos);
  EXPECT_NE(
      warningsOf("package://absent/meshes/a.stl").at(0).find("no package absent for \"package://absent/meshes/a.stl\""),
      std::string::npos);
  EXPECT_EQ(warningsOf("package://").size(), 1U);
  ::unsetenv("ROS_PACKAGE_PATH");
  EXPECT_TRUE(warningsOf("package://absent/meshes/a.stl").empty()) << "no ROS, no rviz";
  if (before != nullptr)
    ::setenv("ROS_PACKAGE_PATH", kept.c_str(), 1);
}

TEST(UrdfReader, AcceptsANamespaceThatXacroLeftBehind)
{
  std::string urdf = urdfWith(kSlide);
  urdf.insert(std::string("<robot").size(), " xmlns:xacro=\"http://www.ros.org/wiki/xacro\"");
  EXPECT_EQ(refusalOf(urdf), "");
  EXPECT_EQ(refusalOf("\xEF\xBB\xBF<?xml version=\"1.0\"?>\r\n" + urdf), "");
}

TEST(UrdfReader, RefusesDeepElementsAndThousandsOfLinks)
{
  std::string deep;
  for (int k = 0; k < 20000; ++k)
    deep += "<a>";
  EXPECT_NE(refusalOf(urdfWith(kSlide, deep)).find("nested deeper than 64 levels"), std::string::npos);
  std::string chain = "<robot name=\"r\"><link name=\"l0\"/>";
  for (int k = 1; k < 10000; ++k)
    chain += "<link name=\"l" + std::to_string(k) + "\"/><joint name=\"j" + std::to_string(k) +
             "\" type=\"fixed\"><parent link=\"l" + std::to_string(k - 1) + "\"/><child link=\"l" + std::to_string(k) +
             "\"/></joint>";
  const std::string text = refusalOf(chain + "</robot>");
  EXPECT_NE(text.find("one of more than 500 links"), std::string::npos) << text;
}

TEST(UrdfReader, RefusesAMissingFile)
{
  EXPECT_THROW(readUrdf(TEST_DATA_DIR "/no_such.urdf"), InputError);
  EXPECT_THROW(readUrdf(TEST_DATA_DIR), InputError) << "a folder";
}

TEST(UrdfReader, ReadsTheExampleWithoutAWarning)
{
  const RobotModel model = readUrdf(PROJECT_DIR "/config/robots/catheter_robot.urdf");
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(model.root_link, "robot_base");
  EXPECT_EQ(model.movableNames(), "catheter_carriage, catheter_chuck, wire_roller, wire_roller_follower, wire_chuck");
}

TEST(UrdfReader, DamagedFilesAreReadOrRefused)
{
  const std::string good =
      urdfWith(kSlide, kWheel + slide("<mimic joint=\"slide\"/>", "roller", "wheel", "continuous"));
  for (std::size_t at = 0; at < good.size(); ++at)
    for (const char damage : {'\0', '<', '"', '9', '-'})
    {
      std::string bad = good;
      bad[at] = damage;
      try
      {
        parseUrdf(bad, "r.urdf");
      }
      catch (const InputError&)
      {
      }
    }
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_NE(refusalOf(good.substr(0, size)).substr(0, 8) == "r.urdf: ", size + 1 >= good.size()) << size;
}

TEST(RobotModel, ChainsOfMimicsAreFollowed)
{
  const RobotModel model = parseUrdf(
      urdfWith(slide("<mimic joint=\"b\" multiplier=\"2\" offset=\"1\"/>", "a", "carriage", "continuous"),
               kWheel + "<link name=\"l\"/>" +
                   slide("<mimic joint=\"c\" multiplier=\"-3\" offset=\"0.5\"/>", "b", "wheel", "continuous") +
                   slide(kAxis, "c", "l", "continuous")),
      "r.urdf");
  std::vector<double> positions = {0.0, 0.0, 0.7};
  followMimics(model, positions, true);
  EXPECT_NEAR(positions[1], -3.0 * 0.7 + 0.5, 1e-15);
  EXPECT_NEAR(positions[0], 2.0 * positions[1] + 1.0, 1e-15);
  std::vector<double> velocities = {0.0, 0.0, 0.1};
  followMimics(model, velocities, false);
  EXPECT_NEAR(velocities[0], -0.6, 1e-15);
}

TEST(UrdfReader, WarnsOfARangeInDegrees)
{
  const auto warningsOf = [](const std::string& upper)
  {
    const std::string limit = "<limit lower=\"-3\" upper=\"" + upper + "\" velocity=\"1\" effort=\"1\"/>";
    return parseUrdf(urdfWith(slide(kAxis + limit, "arm", "carriage", "revolute")), "r.urdf").warnings;
  };
  EXPECT_TRUE(warningsOf("50").empty()) << "a screw of 8 turns";
  ASSERT_EQ(warningsOf("180").size(), 1U);
  EXPECT_NE(warningsOf("180")[0].find("r.urdf: joint 'arm'"), std::string::npos);
  EXPECT_NE(warningsOf("180")[0].find("in degrees? URDF uses rad"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::robot
