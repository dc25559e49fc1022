#include "nodes/vessel_server/clicked_end.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace endovascular_sim::nodes
{
namespace
{

/** A trunk along z with a side branch. */
vessel::CentrelineTree fork()
{
  vessel::CentrelineTree tree;
  tree.branches.push_back({"branch_0", -1, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.05}, {0.0, 0.0, 0.1}}, {4e-3, 4e-3, 4e-3}});
  tree.branches.push_back(
      {"branch_1", 0, {{0.0, 0.0, 0.05}, {0.02, 0.0, 0.06}, {0.04, 0.0, 0.07}}, {2e-3, 2e-3, 2e-3}});
  return tree;
}

scene::VesselScene meshScene()
{
  scene::VesselScene scene;
  scene.mesh = "vessel.obj";
  return scene;
}

TEST(ClickedEnd, IsTheNearestOneWithTheOptionsThatNameIt)
{
  const std::string text = clickedEndText(fork(), meshScene(), {0.041, 0.0, 0.071});
  EXPECT_NE(text.find("the end of branch_1, 1.4 mm from the click, radius of the lumen 2.0 mm"), std::string::npos)
      << text;
  EXPECT_NE(text.find("vessel_prepare or vessel_segment --open 0.04000,0.00000,0.07000\n"), std::string::npos) << text;
  EXPECT_NE(text.find("vessel_segment --closed 0.04000,0.00000,0.07000\n"), std::string::npos) << text;
  EXPECT_NE(text.find("--set entry.position=[0.04000,0.00000,0.07000] --set entry.nearest_centreline_end=true"),
            std::string::npos)
      << text;
}

TEST(ClickedEnd, OptionsOfTheMeshAreInTheFrameOfItsFile)
{
  scene::VesselScene scene = meshScene();
  scene.transform = Eigen::Translation3d(0.0, 0.0, 0.1) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
  const std::string text = clickedEndText(fork(), scene, {0.041, 0.0, 0.071});
  EXPECT_NE(text.find("--open 0.04000,0.00000,0.03000\n"), std::string::npos) << text;
  EXPECT_NE(text.find("entry.position=[0.04000,0.00000,0.07000]"), std::string::npos) << text;
}

TEST(ClickedEnd, OfAGeneratedVesselIsAnEntryOnly)
{
  const std::string text = clickedEndText(fork(), {}, {0.0, 0.0, 0.1});
  EXPECT_NE(text.find("the end of branch_0"), std::string::npos) << text;
  EXPECT_EQ(text.find("--open"), std::string::npos) << text;
}

TEST(ClickedEnd, NeedsAnEndAndAFinitePoint)
{
  EXPECT_NE(clickedEndText({}, meshScene(), {0.0, 0.0, 0.0}).find("no end"), std::string::npos);
  EXPECT_NE(clickedEndText(fork(), meshScene(), {0.0, std::nan(""), 0.0}).find("no end"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::nodes
