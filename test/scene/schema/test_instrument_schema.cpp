#include <gtest/gtest.h>

#include <cmath>

#include "scene/model/scene.h"
#include "scene/scene_file.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kBench = TEST_DATA_DIR "/scenes/good_bench.yaml";

rod::Section sectionOf(const std::string& keys)
{
  return loadScene(kBench,
                   {"instrument={name: w, sections: [{length: 0.1, radius: 2e-4, material: steel, density: 7000, " +
                    keys + "}]}"})
      .instruments.front()
      .instrument.wire.sections.at(0);
}

TEST(SceneInstrument, DerivesStiffnessFromTheMaterial)
{
  const double r = 2e-4;
  const rod::Section section = sectionOf("young_modulus: 60e9, poisson_ratio: 0.25");
  EXPECT_NEAR(section.bending_stiffness, 60e9 * M_PI * std::pow(r, 4) / 4.0, 1e-15);
  EXPECT_NEAR(section.torsional_stiffness, 24e9 * M_PI * std::pow(r, 4) / 2.0, 1e-15);
  EXPECT_NEAR(section.axial_stiffness, 60e9 * M_PI * r * r, 1e-9);
  EXPECT_NEAR(sectionOf("young_modulus: 60e9, shear_modulus: 10e9").torsional_stiffness,
              10e9 * M_PI * std::pow(r, 4) / 2.0, 1e-15);
}

TEST(SceneInstrument, AcceptsStiffnessDirectly)
{
  const rod::Section section =
      sectionOf("bending_stiffness: 1e-4, torsional_stiffness: 3e-5, axial_stiffness: 500, friction: 0.07");
  EXPECT_EQ(section.bending_stiffness, 1e-4);
  EXPECT_EQ(section.torsional_stiffness, 3e-5);
  EXPECT_EQ(section.axial_stiffness, 500.0);
  EXPECT_EQ(section.friction, 0.07);
}

TEST(SceneInstrument, ReadsTheUnitsOfDataSheets)
{
  const std::string text =
      "instrument={name: c, kind: catheter, inner_diameter: 0.047in, sections: [{length: 90cm, diameter: 5F, material: "
      "polymer, density: 1.2 g/cm3, young_modulus: 1.0GPa, shear_modulus: 500 MPa}]}";
  const instrument::Instrument read = loadScene(kBench, {text}).instruments.front().instrument;
  const rod::Section& section = read.wire.sections.at(0);
  EXPECT_DOUBLE_EQ(section.length, 0.9);
  EXPECT_DOUBLE_EQ(section.radius, 2.5e-3 / 3.0);
  EXPECT_DOUBLE_EQ(read.inner_radius, 0.5 * 0.047 * 0.0254);
  EXPECT_DOUBLE_EQ(section.density, 1200.0);
  const double fourth = std::pow(section.radius, 4) - std::pow(read.inner_radius, 4);
  EXPECT_NEAR(section.bending_stiffness, 1e9 * M_PI * fourth / 4.0, 1e-12);
  EXPECT_NEAR(section.torsional_stiffness, 0.5e9 * M_PI * fourth / 2.0, 1e-12);
}

TEST(SceneInstrument, ReadsUnitsInListsAndLoads)
{
  const Scene scene = loadScene(kBench, {"loads.point_loads=[{force: [0, 1.5gf, 20 mN], ramp_time: 100ms}]",
                                         "loads.gravity=[0, 0, -981 cm/s²]", "instrument.sections.0.length=20 cm"});
  const PointLoad& load = scene.loads.point_loads.at(0);
  EXPECT_TRUE(load.force.isApprox(Eigen::Vector3d(0.0, 1.5 * 9.80665e-3, 0.02), 1e-12));
  EXPECT_DOUBLE_EQ(load.ramp_time, 0.1);
  EXPECT_NEAR(scene.loads.gravity.z(), -9.81, 1e-12);
  EXPECT_DOUBLE_EQ(load.position, 0.2);
}

TEST(SceneInstrument, OfADiameterIsThatOfItsRadiusInTheResolvedText)
{
  const std::string rest = "material: steel, density: 7000, bending_stiffness: 1e-4, poisson_ratio: 0.3}]}";
  const auto text = [&rest](const std::string& size)
  { return loadScene(kBench, {"instrument={name: w, sections: [{length: 0.1, " + size + ", " + rest}).resolved_yaml; };
  EXPECT_EQ(text("diameter: 8e-4"), text("radius: 4e-4"));
  EXPECT_EQ(text("diameter: 0.8mm"), text("radius: 4e-4"));
  EXPECT_EQ(text("diameter: 0.8mm").find("diameter"), std::string::npos);
}

TEST(SceneInstrument, DerivesMissingStiffnessesFromTheBendingStiffness)
{
  const rod::Section section = sectionOf("bending_stiffness: 1e-4, poisson_ratio: 0.3");
  EXPECT_NEAR(section.torsional_stiffness, 1e-4 / 1.3, 1e-18);
  EXPECT_NEAR(section.axial_stiffness, 4.0 * 1e-4 / (2e-4 * 2e-4), 1e-9);
}

TEST(SceneInstrument, ReadsRestCurvatureAsVectorOrArc)
{
  const std::string stiffness = "young_modulus: 60e9, poisson_ratio: 0.25, ";
  EXPECT_EQ(sectionOf(stiffness + "rest_curvature: [3, -4]").rest_curvature, Eigen::Vector2d(3, -4));
  EXPECT_TRUE(
      sectionOf(stiffness + "rest_curvature: {radius: 0.02}").rest_curvature.isApprox(Eigen::Vector2d(0, -50), 1e-12));
  EXPECT_TRUE(sectionOf(stiffness + "rest_curvature: {radius: 0.02, direction: 1.5707963267948966}")
                  .rest_curvature.isApprox(Eigen::Vector2d(50, 0), 1e-12));
  EXPECT_TRUE(std::isnan(sectionOf(stiffness + "rest_curvature: [0, 0]").friction));
}

TEST(SceneInstrument, AppliesTheTipShapeToTheDistalSections)
{
  const Scene scene = loadScene(kBench, {"instrument.tip={shape: semicircle, radius: 0.01, straight: 0.005}"});
  const auto& sections = scene.instruments.front().instrument.wire.sections;
  ASSERT_EQ(sections.size(), 3U);
  EXPECT_NEAR(sections[1].length, 0.01 * M_PI, 1e-15);
  EXPECT_NEAR(sections[2].length, 0.005, 1e-15);
  EXPECT_TRUE(sections[0].rest_curvature.isZero(0.0));
  EXPECT_TRUE(sections[1].rest_curvature.isApprox(Eigen::Vector2d(0, -100), 1e-12));
  EXPECT_TRUE(sections[2].rest_curvature.isZero(0.0));
}

TEST(SceneInstrument, DerivesTheStiffnessOfATubeFromItsWall)
{
  const double outer = std::pow(2e-4, 4) - std::pow(1.5e-4, 4);
  const auto tube = [](const std::string& keys)
  {
    return loadScene(kBench, {"instrument={name: c, kind: catheter, inner_radius: 1.5e-4, sections: [{length: 0.1, "
                              "radius: 2e-4, material: polymer, density: 1200, " +
                              keys + "}]}"})
        .instruments.front()
        .instrument.wire.sections.at(0);
  };
  const rod::Section section = tube("young_modulus: 1e9, shear_modulus: 0.4e9");
  EXPECT_NEAR(section.bending_stiffness, 1e9 * M_PI * outer / 4.0, 1e-18);
  EXPECT_NEAR(section.torsional_stiffness, 0.4e9 * M_PI * outer / 2.0, 1e-18);
  EXPECT_NEAR(section.axial_stiffness, 1e9 * M_PI * (4e-8 - 2.25e-8), 1e-9);
  const rod::Section direct = tube("bending_stiffness: 1e-6, poisson_ratio: 0.25");
  EXPECT_NEAR(direct.torsional_stiffness, 0.8e-6, 1e-18);
  EXPECT_NEAR(direct.axial_stiffness, 4e-6 / outer * (4e-8 - 2.25e-8), 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::scene
