#include <gtest/gtest.h>

#include "contact/detector.h"
#include "scene/scene_file.h"
#include "simulation/simulation.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::simulation
{
namespace
{

const std::string kWire =
    "{name: wire, sections: [{length: 0.3, radius: 0.4e-3, young_modulus: 2.0e9, shear_modulus: 0.8e9, density: 6000, "
    "material: nitinol}]}";
const std::string kThickWire =
    "{name: thick, sections: [{length: 0.3, radius: 0.7e-3, young_modulus: 1.0e9, shear_modulus: 0.4e9, density: 6000, "
    "material: nitinol}]}";
const std::string kCatheter =
    "{name: catheter, kind: catheter, inner_radius: 0.5e-3, sections: [{length: 0.28, radius: 0.8e-3, young_modulus: "
    "5.0e8, shear_modulus: 2.0e8, density: 1200, material: polymer}]}";

std::string layer(const std::string& instrument, double insertion)
{
  return "  - {instrument: " + instrument +
         ", drive: {source: script, initial_insertion: " + std::to_string(insertion) + "}}\n";
}

std::string sceneText(const std::string& instruments, const std::string& more = "")
{
  return "name: two\nvessel: {tube: {radius: 3.0e-3, facet_length: 1.0e-3, facets_around: 32, pieces: [{length: 0.05}, "
         "{length: 0.05, curvature: 20.0}, {length: 0.1}]}, friction: 0.1}\nentry: {position: [0, 0, 0], direction: "
         "[0, "
         "0, 1], up: [1, 0, 0]}\nsampling: {kind: uniform, nodes: 151}\n" +
         more + instruments;
}

std::string stack(const std::string& layers, const std::string& more = "")
{
  return sceneText("instruments:\n" + layers, more);
}

struct Bench
{
  explicit Bench(const std::string& text) : scene(scene::parseScene(text, "two.yaml"))
  {
    vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file);
    detector = std::make_unique<contact::Detector>(vessel.mesh, scene::wallLaw(*scene.vessel));
    simulation =
        std::make_unique<Simulation>(scene, scene::resolveEntry(scene.entry, vessel, scene.file), detector.get());
  }

  /** Moves every handle evenly to its target. */
  void move(const std::vector<drive::HandCommand>& to, int steps)
  {
    std::vector<drive::HandCommand> from;
    for (int k = 0; k < simulation->instruments(); ++k)
      from.push_back({simulation->hand(k).insertion, simulation->hand(k).rotation});
    for (int step = 1; step <= steps; ++step)
    {
      std::vector<drive::HandCommand> commands = from;
      const double share = static_cast<double>(step) / steps;
      for (std::size_t k = 0; k < to.size(); ++k)
      {
        commands[k].insertion += share * (to[k].insertion - from[k].insertion);
        commands[k].rotation += share * (to[k].rotation - from[k].rotation);
      }
      simulation->stepAll(commands);
      ASSERT_TRUE(simulation->report().solved);
      ASSERT_LT(simulation->surfacePenetration(), 0.1e-3);
      for (int k = 0; k < simulation->instruments(); ++k)
        ASSERT_TRUE(std::isfinite(simulation->hand(k).force));
    }
  }

  scene::Scene scene;
  vessel::Vessel vessel;
  std::unique_ptr<contact::Detector> detector;
  std::unique_ptr<Simulation> simulation;
};

std::string refusalOf(const std::string& text)
{
  return inputErrorOf([&] { scene::parseScene(text, "two.yaml"); });
}

TEST(Instruments, ACatheterFollowsItsWireAndStaysWhenTheWireLeaves)
{
  Bench bench(stack(layer(kWire, 0.02) + layer(kCatheter, -0.1)));
  bench.move({{0.15, 0.0}, {-0.1, 0.0}}, 2000);
  EXPECT_NEAR(bench.simulation->hand(0).insertion, 0.15, 1e-9);
  EXPECT_LT(bench.simulation->hand(1).insertion, 0.0);
  bench.move({{0.15, 0.0}, {0.12, 0.5}}, 2000);
  EXPECT_NEAR(bench.simulation->hand(1).insertion, 0.12, 1e-9);
  EXPECT_NEAR(bench.simulation->hand(1).rotation, 0.5, 1e-9);
  bench.move({{-0.1, 0.0}, {0.12, 0.5}}, 2500);
  EXPECT_LT(bench.simulation->hand(0).insertion, 0.0);
  EXPECT_NEAR(bench.simulation->hand(1).insertion, 0.12, 1e-9);
}

TEST(Instruments, AnInstrumentThatDoesNotFitWaitsOutsideUntilTheOtherHasLeft)
{
  Bench bench(stack(layer(kThickWire, 0.05) + layer(kCatheter, -0.1)));
  const double outside = bench.simulation->hand(1).insertion;
  bench.move({{0.05, 0.0}, {0.06, 0.0}}, 500);
  EXPECT_NEAR(bench.simulation->hand(1).insertion, outside, 0.2e-3) << "the wire is thicker than the lumen";
}

TEST(Instruments, TheLastOneInsideDoesNotLeaveTheIntroducer)
{
  Bench bench(stack(layer(kWire, 0.05) + layer(kCatheter, -0.1)));
  bench.move({{-0.1, 0.0}, {-0.1, 0.0}}, 800);
  EXPECT_NEAR(bench.simulation->hand(0).insertion, 0.0, 1e-9);
}

TEST(Instruments, OneAloneInTheListIsTheSameSceneAsWithoutAList)
{
  const scene::Scene listed = scene::parseScene(stack(layer(kWire, 0.05)), "two.yaml");
  const scene::Scene single = scene::parseScene(
      sceneText("instrument: " + kWire + "\ndrive: {source: script, initial_insertion: 0.05}\n"), "two.yaml");
  EXPECT_EQ(listed.hash(), single.hash());
}

TEST(Instruments, SeveralAreReadBackFromTheResolvedText)
{
  const scene::Scene scene = scene::parseScene(stack(layer(kWire, 0.05) + layer(kCatheter, -0.1)), "two.yaml");
  const scene::Scene again = scene::parseScene(scene.resolved_yaml, "two.yaml");
  ASSERT_EQ(again.instruments.size(), 2U);
  EXPECT_EQ(again.hash(), scene.hash());
  EXPECT_EQ(again.instruments[1].drive.initial_insertion, -0.1);
  EXPECT_EQ(scene.longest(), 0.3);
}

TEST(Instruments, AreRefusedWithAReason)
{
  const std::string both = layer(kWire, 0.05) + layer(kCatheter, -0.1);
  EXPECT_EQ(refusalOf(stack(both)), "");
  EXPECT_NE(refusalOf(stack(layer(kThickWire, 0.05) + layer(kCatheter, 0.05))).find("does not fit"), std::string::npos);
  EXPECT_NE(refusalOf(stack(layer(kWire, 0.05) + layer(kWire, -0.1))).find("instruments.1.instrument.name"),
            std::string::npos);
  EXPECT_NE(refusalOf(stack(layer(kWire, -0.1) + layer(kCatheter, -0.1))).find("leaves no instrument"),
            std::string::npos);
  EXPECT_NE(refusalOf(stack(both, "solver: {scheme: paper}\n")).find("solver.scheme"), std::string::npos);
  EXPECT_NE(refusalOf(stack(both, "instrument: " + kWire + "\n")).find("conflicts with instruments"),
            std::string::npos);
}

TEST(Instruments, OnlyABalloonGetsThePressureOfItsDrive)
{
  const scene::Scene scene = scene::parseScene(
      stack(layer(kWire, 0.05) + "  - {instrument: {use: balloon_300_12_nc, name: balloon}, drive: {source: script, "
                                 "initial_insertion: -0.1, pressure: {points: [[0, 0], [1, 8.0e5]]}}}\n"),
      "two.yaml");
  const std::vector<drive::HandCommand> commands = commandsAt(scene, 0.5);
  EXPECT_EQ(commands[0].pressure, 0.0);
  EXPECT_EQ(commands[1].pressure, 4.0e5);
  EXPECT_EQ(scene::parseScene(scene.resolved_yaml, "two.yaml").hash(), scene.hash());
  Bench bench(stack(layer(kWire, 0.05) + layer(kCatheter, -0.1)));
  EXPECT_THROW(bench.simulation->stepAll({{0.05, 0.0, 1.0e5}, {-0.1, 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::simulation
