#include "segmentation/clicks/click_set.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::segmentation
{
namespace
{

class Clicks : public ::testing::Test
{
protected:
  std::string file(const std::string& name, const std::string& text) { return folder_.write(name, text); }

  std::string errorOf(const std::string& name, const std::string& text)
  {
    return inputErrorOf([&] { readClicks(file(name, text)); });
  }

private:
  TemporaryFolder folder_;
};

const char* const kYaml = R"(frame: RAS
unit: 0.001
branches:
  - name: LAD
    clicks: [[1, 2, 3], [4, 5, 6]]
    largest_radius: 4
)";

TEST_F(Clicks, OfYamlAreInMetresAndLps)
{
  const ClickSet set = readClicks(file("a.yaml", kYaml));
  ASSERT_EQ(set.branches.size(), 1u);
  EXPECT_EQ(set.branches[0].name, "LAD");
  EXPECT_TRUE(set.branches[0].clicks[0].position.isApprox(Eigen::Vector3d(-0.001, -0.002, 0.003)));
  EXPECT_DOUBLE_EQ(set.branches[0].largest_radius, 0.004);
  EXPECT_EQ(set.branches[0].clicks[0].where, "line 5");
}

TEST_F(Clicks, OfMarkupsHaveTheCoordinateSystemOfTheFile)
{
  for (const std::string system : {"\"LPS\"", "\"RAS\"", "0", "1"})
  {
    const double sign = system == "\"LPS\"" || system == "1" ? 1.0 : -1.0;
    const ClickSet set =
        readClicks(file("c.mrk.json", R"({"markups": [{"type": "Fiducial", "coordinateSystem": )" + system +
                                          R"(, "coordinateUnits": "mm", "controlPoints": [
      {"label": "LAD-1", "position": [1, 2, 3], "positionStatus": "defined"},
      {"label": "RCA-1", "position": [7, 8, 9], "positionStatus": "defined"},
      {"label": "LAD-2", "position": [4, 5, 6], "positionStatus": "defined"},
      {"label": "LAD-3", "position": [0, 0, 0], "positionStatus": "undefined"},
      {"label": "RCA-2", "position": [7, 8, 10], "positionStatus": "defined"}]}]})"));
    ASSERT_EQ(set.branches.size(), 2u);
    EXPECT_EQ(set.branches[0].name, "LAD");
    EXPECT_EQ(set.branches[1].name, "RCA");
    ASSERT_EQ(set.branches[0].clicks.size(), 2u);
    EXPECT_TRUE(set.branches[0].clicks[1].position.isApprox(1e-3 * Eigen::Vector3d(sign * 4, sign * 5, 6)));
  }
}

TEST_F(Clicks, WithDefaultLabelsHaveTheNameOfTheFile)
{
  const std::string text = R"({"markups": [{"coordinateSystem": "LPS", "controlPoints": [
      {"label": "F-1", "position": [1, 2, 3]}, {"label": "F-2", "position": [4, 5, 6]}]}]})";
  EXPECT_EQ(readClicks(file("left_circumflex.mrk.json", text)).branches[0].name, "left_circumflex");
}

TEST_F(Clicks, OfFiducialListsAreRead)
{
  const ClickSet set = readClicks(file("RCA.fcsv",
                                       "# Markups fiducial file version = 4.10\r\n# CoordinateSystem = RAS\r\n"
                                       "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\r\n"
                                       "vtk_1,1,2,3,0,0,0,1,1,1,0,F-1,,\r\nvtk_2,4,5,6,0,0,0,1,1,1,0,F-2,,\r\n"));
  ASSERT_EQ(set.branches.size(), 1u);
  EXPECT_EQ(set.branches[0].name, "RCA");
  EXPECT_TRUE(set.branches[0].clicks[1].position.isApprox(Eigen::Vector3d(-0.004, -0.005, 0.006)));
}

TEST_F(Clicks, AtOnePlaceAreRefusedByTheirNumbers)
{
  EXPECT_NE(errorOf("a.yaml", "branches:\n  - name: a\n    clicks: [[1, 2, 3], [1, 2, 3.05]]\n")
                .find("a: clicks 1 and 2 are at the same place"),
            std::string::npos);
  EXPECT_NE(errorOf("a.yaml", "branches:\n  - name: a\n    clicks: [[1, 2, 3], [7, 2, 3], [1, 2, 3]]\n")
                .find("clicks 1 and 3 are at the same place"),
            std::string::npos);
}

TEST_F(Clicks, OfMarkupsWithoutACourseAreRefusedByType)
{
  for (const std::string type : {"ClosedCurve", "ROI", "Plane", "Angle"})
    EXPECT_NE(errorOf("a.mrk.json", R"({"markups": [{"type": ")" + type +
                                        R"(", "coordinateSystem": "LPS", "controlPoints": [
        {"label": "CC-1", "position": [1, 2, 3]}, {"label": "CC-2", "position": [4, 5, 6]}]}]})")
                  .find("markup 1: is a " + type + ", which has no two ends"),
              std::string::npos);
  EXPECT_EQ(errorOf("a.mrk.json", R"({"markups": [{"type": "Curve", "coordinateSystem": "LPS", "controlPoints": [
        {"label": "C-1", "position": [1, 2, 3]}, {"label": "C-2", "position": [4, 5, 6]}]}]})"),
            "");
}

TEST_F(Clicks, OfMarkupsHaveTheUnitOfTheFile)
{
  const std::string rest = R"("coordinateSystem": "LPS", "controlPoints": [
      {"label": "LAD-1", "position": [0.1, 0.2, 0.3]}, {"label": "LAD-2", "position": [0.1, 0.2, 0.4]}]}]})";
  const ClickSet set = readClicks(file("a.mrk.json", R"({"markups": [{"coordinateUnits": "m", )" + rest));
  EXPECT_TRUE(set.branches[0].clicks[0].position.isApprox(Eigen::Vector3d(0.1, 0.2, 0.3)));
  EXPECT_NE(errorOf("a.mrk.json", R"({"markups": [{"coordinateUnits": "px", )" + rest).find("must be mm, cm, m or um"),
            std::string::npos);
}

TEST_F(Clicks, WithoutALabelAmongLabelledOnesAreNamed)
{
  EXPECT_NE(errorOf("a.mrk.json", R"({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "controlPoints": [
        {"label": "LAD", "position": [1, 2, 3]}, {"label": "LAD", "position": [4, 5, 6]},
        {"label": "", "position": [7, 8, 9]}]}]})")
                .find("markup 1, point 3: has no label, others of its list have one; label it as those of its branch, "
                      "e.g. LAD-3"),
            std::string::npos);
}

TEST_F(Clicks, OfFiducialListsMayHaveQuotedLabelsWithCommas)
{
  const ClickSet set = readClicks(file("a.fcsv",
                                       "# CoordinateSystem = RAS\nvtk_1,1,2,3,0,0,0,1,1,1,0,\"LAD-1, ostium\",,v\n"
                                       "vtk_2,4,5,6,0,0,0,1,1,1,0,\"LAD-2, apex\",,v\n"));
  ASSERT_EQ(set.branches.size(), 1u);
  EXPECT_EQ(set.branches[0].name, "LAD");
  EXPECT_EQ(set.branches[0].clicks.size(), 2u);
}

TEST_F(Clicks, OfAListOfEndpointsAreEndsAndBeginWithThePointThatIsNotSelected)
{
  const auto markups = [this](const std::string& name, const std::string& label)
  {
    return readClicks(file(name, R"({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "controlPoints": [
      {"label": ")" + label + R"(-1", "position": [1, 2, 3]},
      {"label": ")" + label + R"(-2", "position": [4, 5, 6], "selected": false},
      {"label": ")" + label + R"(-3", "position": [7, 8, 9]}]}]})"))
        .branches.at(0);
  };
  for (const BranchClicks& ends : {markups("a.mrk.json", "Endpoints"), markups("endpoints_of_y.mrk.json", "F")})
  {
    EXPECT_TRUE(ends.are_ends);
    ASSERT_EQ(ends.clicks.size(), 3u);
    EXPECT_DOUBLE_EQ(ends.clicks[0].position.x(), 0.004);
    EXPECT_DOUBLE_EQ(ends.clicks[1].position.x(), 0.001);
  }
  const BranchClicks course = markups("a.mrk.json", "LAD");
  EXPECT_FALSE(course.are_ends);
  EXPECT_DOUBLE_EQ(course.clicks[0].position.x(), 0.001);
  const ClickSet list = readClicks(file("Endpoints.fcsv",
                                        "# CoordinateSystem = LPS\na,1,2,3,0,0,0,1,1,1,0,F-1,,\n"
                                        "b,4,5,6,0,0,0,1,1,0,0,F-2,,\n"));
  EXPECT_TRUE(list.branches[0].are_ends);
  EXPECT_DOUBLE_EQ(list.branches[0].clicks[0].position.x(), 0.004);
  EXPECT_TRUE(readClicks(file("a.yaml", "branches: [{name: y, ends: [[1, 2, 3], [4, 5, 6], [7, 8, 9]]}]\n"))
                  .branches[0]
                  .are_ends);
  EXPECT_NE(errorOf("a.yaml", "branches: [{name: y, ends: [[1, 2, 3]], clicks: [[4, 5, 6]]}]\n")
                .find("ends (line 1): excludes clicks"),
            std::string::npos);
}

TEST_F(Clicks, HaveNamesInAnyScript)
{
  const auto nameIn = [this](const std::string& label)
  {
    return readClicks(file("a.mrk.json", R"({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS",
      "controlPoints": [{"label": ")" + label +
                                             R"(-1", "position": [1, 2, 3]}, {"label": ")" + label +
                                             R"(-2", "position": [4, 5, 6]}]}]})"))
        .branches.at(0)
        .name;
  };
  EXPECT_EQ(nameIn("冠状動脈"), "冠状動脈");
  EXPECT_EQ(nameIn("Aorta ascendens – größe"), "Aorta_ascendens_–_größe");
  const std::string yaml = "branches:\n  - name: ";
  const std::string clicks = "\n    clicks: [[1, 2, 3], [4, 5, 6]]\n";
  EXPECT_EQ(readClicks(file("a.yaml", yaml + "größe" + clicks)).branches[0].name, "größe");
  EXPECT_NE(errorOf("a.yaml", yaml + "a/b" + clicks).find("letters of any script"), std::string::npos);
  EXPECT_NE(errorOf("a.mrk.json", R"({"markups": [
      {"coordinateSystem": "LPS", "controlPoints": [{"label": "LM 1", "position": [1, 2, 3]}, {"label": "LM 2", "position": [4, 5, 6]}]},
      {"coordinateSystem": "LPS", "controlPoints": [{"label": "LM-1", "position": [1, 2, 4]}, {"label": "LM-2", "position": [4, 5, 7]}]}]})")
                .find("LM: is the name of two branches"),
            std::string::npos);
}

TEST_F(Clicks, AreRefusedWithPlaceAndRemedy)
{
  EXPECT_NE(errorOf("a.txt", "").find("3D Slicer"), std::string::npos);
  EXPECT_NE(errorOf("a.yaml", "branches:\n  - name: a\n    click: []\n")
                .find("branches[a].click (line 3): unknown key; did you mean \"clicks\"?"),
            std::string::npos);
  EXPECT_NE(errorOf("a.yaml", "branches:\n  - name: a\n    clicks: [[1, 2, 3]]\n").find("a: has 1 click(s)"),
            std::string::npos);
  EXPECT_NE(errorOf("a.yaml", "branches:\n  - name: a\n    clicks: [[1, 2], [1, 2, 3]]\n")
                .find("branches[a].clicks.0 (line 3): expected a list of 3 numbers"),
            std::string::npos);
  EXPECT_NE(errorOf("a.yaml", "frame: ITK\nbranches: [{name: a, clicks: [[1, 2, 3], [4, 5, 6]]}]\n")
                .find("frame (line 1): is \"ITK\"; must be one of LPS, RAS"),
            std::string::npos);
  EXPECT_NE(errorOf("a.yaml", "branches:\n  - name: a\n    clicks: [[1, 2, .nan], [4, 5, 6]]\n")
                .find("branches[a].clicks.0.2 (line 3): is not a number (NaN)"),
            std::string::npos);
  EXPECT_NE(errorOf("a.yaml", "branches: [").find("not valid YAML"), std::string::npos);
  EXPECT_NE(errorOf("a.mrk.json", "{}").find("no markups file"), std::string::npos);
  EXPECT_NE(errorOf("a.fcsv", "1,1,2,3\n").find("CoordinateSystem"), std::string::npos);
  const std::string one = file("one.yaml", kYaml);
  EXPECT_THROW(readClicks(std::vector<std::string>{one, one}), InputError);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
