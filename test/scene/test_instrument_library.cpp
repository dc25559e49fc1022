#include "scene/instrument_library.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>

#include "instrument/rest_shape.h"
#include "rod/model/discretisation.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

using instrument::Instrument;
using instrument::Kind;

const std::string kBench = TEST_DATA_DIR "/scenes/good_bench.yaml";
const std::string kLibrary = std::string(PROJECT_DIR) + "/config/instruments/";

Instrument load(const std::string& name, const std::vector<std::string>& overrides = {})
{
  return loadInstrument(kLibrary + name + ".yaml", overrides);
}

std::vector<std::string> names()
{
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(kLibrary))
    found.push_back(entry.path().stem().string());
  return found;
}

double degreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / M_PI;
}

/** Tangent at the end of a section. */
Eigen::Vector3d tangentAfter(const Instrument& instrument, std::size_t section)
{
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();
  for (const instrument::RestPoint& point : instrument::restShape(instrument.wire, 1e-3))
    if (point.section == section)
      tangent = point.tangent;
  return tangent;
}

TEST(InstrumentLibrary, AllFilesAreValidWithPlausibleShafts)
{
  EXPECT_GE(names().size(), 24U);
  for (const std::string& name : names())
  {
    SCOPED_TRACE(name);
    const Instrument instrument = load(name);
    ASSERT_EQ(instrument.materials.size(), instrument.wire.sections.size());
    if (instrument.kind == Kind::kStent)
      continue;
    const double length = instrument.wire.length();
    EXPECT_GT(length, 0.25);
    EXPECT_LT(length, 1.3);
    const double weight = rod::massBetween(instrument.wire, 0.0, length) / length;
    EXPECT_GT(weight, 0.5e-3);  // lower limit: 0.014" wire
    EXPECT_LT(weight, 5.0e-3);  // upper limit: 6F catheter
    double previous = 5e-3;     // above the stiffest wire in use, 4857 N·mm²
    for (const rod::Section& section : instrument.wire.sections)
    {
      EXPECT_LE(section.bending_stiffness, previous) << "must not become stiffer towards the tip";
      previous = section.bending_stiffness * (1.0 + 1e-9);
      EXPECT_GT(section.bending_stiffness, 0.2e-6);  // lower limit: tip of a balloon catheter
      EXPECT_GE(section.bending_stiffness / section.torsional_stiffness, 0.99);
      EXPECT_LE(section.bending_stiffness / section.torsional_stiffness, 1.5);
      EXPECT_GT(section.radius, instrument.inner_radius);
    }
    if (instrument.kind == Kind::kCatheter && name != "microcatheter")
    {
      EXPECT_GT(instrument.wire.sections.front().bending_stiffness, 200e-6);
      EXPECT_LT(instrument.wire.sections.front().bending_stiffness, 1000e-6);
    }
  }
}

TEST(InstrumentLibrary, ShaftStiffnessesMatchPublishedValues)
{
  // Harrison et al. 2011: published data of 0.035" wires [N·mm²].
  for (const auto& [name, stiffness] :
       std::vector<std::pair<std::string, double>>{{"guidewire_035_floppy", 291.0},
                                                   {"guidewire_035_j", 291.0},
                                                   {"guidewire_035_stiff", 521.0},
                                                   {"guidewire_035_super_stiff", 1849.0},
                                                   {"guidewire_035_lunderquist", 4857.0}})
    EXPECT_NEAR(1e6 * load(name).wire.sections.front().bending_stiffness, stiffness, 1e-9) << name;
  // E·π (R⁴ − r⁴)/4 of the 5F catheter: 1 GPa · 0.2820 mm⁴.
  EXPECT_NEAR(1e6 * load("catheter_5f_jl4").wire.sections.front().bending_stiffness, 282.0, 0.5);
}

TEST(InstrumentLibrary, WiresAndBalloonsFitTheirCatheters)
{
  for (const std::string& name : names())
  {
    SCOPED_TRACE(name);
    const Instrument outer = load(name);
    const bool guide = name.rfind("guide_", 0) == 0;
    std::vector<std::string> inner;
    if (outer.inner_radius > 0.0)
      inner = {"guidewire_014_workhorse", "guidewire_014_cto"};
    if (guide || name.rfind("catheter_", 0) == 0)
      inner.insert(inner.end(), {"guidewire_035_j", "guidewire_035_lunderquist", "microcatheter"});
    if (guide)
      inner.insert(inner.end(), {"balloon_250_15", "balloon_300_12_nc", "stent_system_300_18"});
    for (const std::string& each : inner)
      EXPECT_TRUE(fitsInside(load(each), outer)) << each;
    if (outer.kind == Kind::kBalloonCatheter || name == "microcatheter")
    {
      EXPECT_FALSE(fitsInside(load("guidewire_035_j"), outer));
    }
  }
  EXPECT_FALSE(fitsInside(load("catheter_6f_jl4"), load("guide_6f_jl4")));
}

TEST(InstrumentLibrary, Jl4HasItsDocumentedAngles)
{
  for (const char* name : {"catheter_5f_jl4", "catheter_6f_jl4", "guide_6f_jl4"})
  {
    SCOPED_TRACE(name);
    const Instrument catheter = load(name);
    const auto& sections = catheter.wire.sections;
    ASSERT_EQ(sections.size(), 7U);
    const Eigen::Vector3d shaft = tangentAfter(catheter, 1);
    const Eigen::Vector3d arm = tangentAfter(catheter, 3);
    const Eigen::Vector3d tip = tangentAfter(catheter, 6);
    EXPECT_NEAR(degreesBetween(shaft, arm), 180.0, 0.01);
    EXPECT_NEAR(degreesBetween(arm, tip), 90.0, 0.01);
    EXPECT_NEAR(sections[3].length, 0.040, 1e-12);
    EXPECT_NEAR(catheter.wire.length(), 0.900, 1e-8);
    // The tip points back towards the shaft, i.e. the z axis.
    const Eigen::Vector3d end = instrument::restShape(catheter.wire, 1e-3).back().position;
    EXPECT_LT(tip.dot(Eigen::Vector3d(end.x(), end.y(), 0.0)), 0.0);
  }
}

TEST(InstrumentLibrary, OtherCathetersHaveTheirDocumentedAngles)
{
  const auto whole_turn = [](const Instrument& instrument)
  {
    double angle = 0.0;
    for (const rod::Section& section : instrument.wire.sections)
      angle += section.length * section.rest_curvature.norm();
    return angle * 180.0 / M_PI;
  };
  for (const std::string size : {"catheter_5f_", "catheter_6f_"})
  {
    EXPECT_NEAR(whole_turn(load(size + "jr4")), 120.0, 0.01);
    EXPECT_NEAR(whole_turn(load(size + "pigtail")), 330.0, 0.01);
    EXPECT_NEAR(whole_turn(load(size + "multipurpose")), 60.0, 0.01);
  }
}

TEST(InstrumentLibrary, BalloonsReachTheirNominalDiameterAtNominalPressure)
{
  for (const auto& [name, label] : std::vector<std::pair<std::string, double>>{
           {"balloon_250_15", 2.5e-3}, {"balloon_300_12_nc", 3.0e-3}, {"stent_system_300_18", 3.0e-3}})
  {
    SCOPED_TRACE(name);
    const instrument::Balloon balloon = load(name).balloon.value();
    EXPECT_NEAR(balloon.nominalDiameter(), label, 1e-5);
    double before = balloon.diameterAt(0.0);
    for (double pressure = 1e4; pressure <= balloon.burst_pressure; pressure += 1e4)
    {
      EXPECT_GT(balloon.diameterAt(pressure), before) << pressure;
      before = balloon.diameterAt(pressure);
    }
    EXPECT_LT(balloon.diameterAt(balloon.rated_burst_pressure), 1.12 * label);
  }
}

TEST(InstrumentLibrary, StentSystemsCarryTheStentOfTheirFile)
{
  const Instrument system = load("stent_system_300_18");
  const Instrument stent = load("stent_300_18");
  ASSERT_TRUE(system.stent.has_value());
  EXPECT_EQ(system.stent->strut_thickness, stent.stent->strut_thickness);
  EXPECT_EQ(system.stent->expansion.size(), stent.stent->expansion.size());
  EXPECT_EQ(load("stent_system_300_18", {"stent.recoil=0.02"}).stent->recoil, 0.02);
}

TEST(InstrumentLibrary, ScenesReferToInstrumentsByUseOrFileWithOverridingKeys)
{
  const Scene by_name = loadScene(kBench, {"instrument={use: guidewire_035_j, name: wire, tip: {radius: 0.005}}"});
  EXPECT_EQ(by_name.instruments.front().instrument.name, "wire");
  EXPECT_NEAR(by_name.instruments.front().instrument.wire.sections.back().rest_curvature.norm(), 200.0, 1e-9);
  const Scene by_file = loadScene(kBench, {"instrument={file: instruments/guidewire_035_j.yaml}"});
  EXPECT_EQ(by_file.hash(), loadScene(kBench, {"instrument=instruments/guidewire_035_j.yaml"}).hash());
  EXPECT_EQ(by_file.hash(), loadScene(kBench, {"instrument={use: guidewire_035_j}"}).hash());
}

TEST(InstrumentLibrary, AnOverrideWithAnotherInstrumentDropsTheKeysOfThePreviousOne)
{
  const Scene scene = loadScene(kBench, {"instrument.use=catheter_5f_jl4"});
  EXPECT_EQ(scene.hash(), loadScene(kBench, {"instrument={use: catheter_5f_jl4}"}).hash());
  EXPECT_EQ(scene.instruments.front().instrument.name, "catheter");
}

TEST(InstrumentLibrary, ResolvedScenesReadBackToTheSameInstrument)
{
  for (const char* name : {"catheter_6f_jr4", "stent_system_300_18", "microcatheter", "guidewire_014_cto"})
  {
    const Scene scene = loadScene(kBench, {std::string("instrument={use: ") + name + "}"});
    EXPECT_EQ(parseScene(scene.resolved_yaml, "resolved").hash(), scene.hash()) << name;
    EXPECT_EQ(parseScene(scene.resolved_yaml, "resolved").instruments.front().instrument.inner_radius,
              scene.instruments.front().instrument.inner_radius);
  }
}

struct Refusal
{
  std::string instrument;
  std::string change;
  std::string location;
  std::string remedy;
};

const std::vector<Refusal> kRefusals = {
    {"catheter_5f_jl4", "inner_radius=-1e-3", "inner_radius (--set)", "must be positive in m"},
    {"catheter_5f_jl4", "inner_radius=0.9e-3", "sections.0.radius (line 15)", "must be greater than inner_radius"},
    {"catheter_5f_jl4", "inner_radius=null", "inner_radius", "missing; give a number in m"},
    {"catheter_5f_jl4", "kind=sheath", "kind (--set)", "one of guidewire, catheter, balloon_catheter, stent"},
    {"catheter_5f_jl4", "kind=guidewire", "inner_radius (line 12)", "set kind: catheter"},
    {"catheter_5f_jl4", "kind=balloon_catheter", "balloon.", "missing"},
    {"catheter_5f_jl4", "balloon={length: 0.01}", "balloon (--set)", "set kind: balloon_catheter"},
    {"catheter_5f_jl4", "stent={use: stent_300_18}", "stent", "set kind: balloon_catheter, or stent"},
    {"catheter_5f_jl4", "sections.0.length=-1", "sections.0.length (--set)", "must be positive in m"},
    {"catheter_5f_jl4", "tip={shape: semicircle, radius: 1}", "tip (--set)", "shorten the tip"},
    {"microcatheter", "markers.0.from_tip=1.5", "markers.0.from_tip (--set)", "at most its length, 1.0"},
    {"guidewire_035_j", "inner_radius=1e-4", "inner_radius (--set)", "a guidewire has no lumen"},
    {"balloon_250_15", "balloon.from_tip=0.99", "balloon.from_tip (--set)", "at most its length"},
    {"balloon_250_15", "balloon.compliance=[[3e5, 2.2e-3], [2e5, 2.3e-3]]", "balloon.compliance.1 (--set)",
     "pressures must increase"},
    {"balloon_250_15", "balloon.compliance=[[3e5, 2.2e-3], [4e5, 2.1e-3]]", "balloon.compliance.1 (--set)",
     "diameters must increase"},
    {"balloon_250_15", "balloon.compliance=[[3e5, 0.2e-3], [4e5, 2.1e-3]]", "balloon.compliance.0 (--set)",
     "greater than folded_diameter"},
    {"balloon_250_15", "balloon.compliance=[[-3e5, 2.2e-3], [4e5, 2.3e-3]]", "balloon.compliance.0 (--set)",
     "must be positive"},
    {"balloon_250_15", "balloon.compliance=[[3e5, 2.2e-3]]", "balloon.compliance (--set)", "two rows or more"},
    {"balloon_250_15", "balloon.nominal_pressure=99e5", "balloon.nominal_pressure (--set)", "first and last pressure"},
    {"balloon_250_15", "balloon.rated_burst_pressure=1e5", "balloon.rated_burst_pressure (--set)",
     "at least nominal_pressure"},
    {"balloon_250_15", "balloon.burst_pressure=9e5", "balloon.burst_pressure (--set)", "at least rated_burst_pressure"},
    {"balloon_250_15", "stent={use: stent_300_18}", "stent (--set)", "longer than its balloon"},
    {"balloon_250_15", "stent={use: guidewire_035_j}", "stent", "is not a stent"},
    {"balloon_250_15", "stent={use: stent_300_81}", "stent.use (--set)", "did you mean \"stent_300_18\"?"},
    {"stent_300_18", "stent.expansion=[[1e-3, 18e-3], [3e-3, 19e-3]]", "stent.expansion.1 (--set)",
     "lengths must not increase"},
    {"stent_300_18", "stent.expansion=[[3e-3, 18e-3], [2e-3, 17e-3]]", "stent.expansion.1 (--set)",
     "diameters must increase"},
    {"stent_300_18", "stent.nominal_diameter=5e-3", "stent.nominal_diameter (--set)", "outside the table"},
    {"stent_300_18", "stent.crimped_diameter=3.5e-3", "stent.crimped_diameter (--set)", "less than nominal_diameter"},
    {"stent_300_18", "stent.strut_thickness=1e-3", "stent.strut_thickness (--set)", "half of crimped_diameter"},
    {"stent_300_18", "stent.recoil=0.9", "stent.recoil (--set)", "between 0 and 0.5"},
    {"stent_300_18", "sections=[{length: 1}]", "sections (--set)", "unknown key"},
};

class InstrumentRefusal : public ::testing::TestWithParam<Refusal>
{
};

TEST_P(InstrumentRefusal, ReportsFileKeyAndRemedy)
{
  const Refusal& expected = GetParam();
  const std::string message = inputErrorOf([&] { load(expected.instrument, {expected.change}); });
  EXPECT_NE(message.find(expected.instrument + ".yaml: "), std::string::npos) << message;
  EXPECT_NE(message.find(expected.location), std::string::npos) << message;
  EXPECT_NE(message.find(expected.remedy), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(All, InstrumentRefusal, ::testing::ValuesIn(kRefusals));

void expectSceneRefusal(const std::string& change, const std::string& location, const std::string& remedy)
{
  const std::string message = inputErrorOf([&] { loadScene(kBench, {change}); });
  EXPECT_NE(message.find(location), std::string::npos) << message;
  EXPECT_NE(message.find(remedy), std::string::npos) << message;
}

TEST(InstrumentLibrary, ScenesRejectUnknownNamesTwoNamesAndSeparateStents)
{
  expectSceneRefusal("instrument={use: guidewire_035_jj}", "instrument.use (--set)",
                     "did you mean \"guidewire_035_j\"?");
  expectSceneRefusal("instrument={use: ../scenes/demo}", "instrument.use (--set)", "no instrument");
  expectSceneRefusal("instrument={use: microcatheter, file: a.yaml}", "instrument.file (--set)", "keep one of the two");
  expectSceneRefusal("instrument={file: nowhere.yaml}", "instrument.file (--set)", "no such file");
  expectSceneRefusal("instrument={use: stent_300_18}", "instrument.kind", "name a balloon_catheter that carries it");
}

}  // namespace
}  // namespace endovascular_sim::scene
