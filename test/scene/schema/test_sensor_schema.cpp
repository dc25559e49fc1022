#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kTracker =
    "{name: tracker, kind: em_tracker, rate: 100, delay: 0.02, drop_out: 0.05,"
    " noise: {position: 5.0e-4, angle: 0.01}, bias: {position: [1.0e-3, 0, 0]}, seed: 3}";

std::string sceneText(const std::string& rest)
{
  return "name: s\ninstrument: {name: wire, sections: [{length: 0.4, radius: 4e-4, young_modulus: 2.0e10, "
         "poisson_ratio: 0.3, density: 6000, material: nitinol}]}\ndrive: {source: topic}\n" +
         rest + "\n";
}

std::string sensors(const std::string& list)
{
  return sceneText("sensors: [" + list + "]");
}

std::string faults(const std::string& list)
{
  return sceneText("faults: [" + list + "]");
}

std::string refusalOf(const std::string& text)
{
  return inputErrorOf([&] { parseScene(text, "s.yaml"); });
}

struct Refusal
{
  std::string text;
  std::string key;
  std::string message;
};

void expectRefusals(const std::vector<Refusal>& refusals)
{
  for (const Refusal& refusal : refusals)
  {
    const std::string message = refusalOf(refusal.text);
    EXPECT_NE(message.find(refusal.key), std::string::npos) << refusal.text << "\n" << message;
    EXPECT_NE(message.find(refusal.message), std::string::npos) << refusal.text << "\n" << message;
  }
}

TEST(SensorSchema, ASensorHasItsErrorsAndItsTimes)
{
  const Scene scene = parseScene(sensors(kTracker), "s.yaml");
  ASSERT_EQ(scene.sensors.size(), 1U);
  const sensor::SensorSettings& tracker = scene.sensors.front();
  EXPECT_EQ(tracker.name, "tracker");
  EXPECT_EQ(tracker.kind, sensor::SensorKind::kEmTracker);
  EXPECT_EQ(tracker.rate, 100.0);
  EXPECT_EQ(tracker.delay, 0.02);
  EXPECT_EQ(tracker.drop_out, 0.05);
  EXPECT_EQ(tracker.seed, 3U);
  EXPECT_EQ(tracker.noise, (std::array<double, 6>{5e-4, 5e-4, 5e-4, 0.01, 0.01, 0.01}));
  EXPECT_EQ(tracker.bias, (std::array<double, 6>{1e-3, 0, 0, 0, 0, 0}));
}

TEST(SensorSchema, TheResolvedTextGivesTheSameSensorsAndFaults)
{
  const Scene scene = parseScene(
      sensors(kTracker + ", {name: hand, kind: force_sensor, bias: {torque: -0.001}}") +
          "faults: [{axis: rotation, kind: backlash, play: 0.2, start: 1, end: 2, probability: 0.5, seed: 4}]\n",
      "s.yaml");
  const Scene again = parseRecordedScene(scene.resolved_yaml, "r.yaml");
  EXPECT_EQ(again.resolved_yaml, scene.resolved_yaml);
  EXPECT_EQ(again.sensors.at(1).bias[1], -0.001);
  EXPECT_EQ(again.faults.at(0).amount, 0.2);
  EXPECT_EQ(again.faults.at(0).end, 2.0);
  EXPECT_EQ(again.faults.at(0).seed, 4U);
}

TEST(SensorSchema, ASceneWithoutSensorsAndFaultsHasTheTextOfBefore)
{
  const std::string text = parseScene(sceneText(""), "s.yaml").resolved_yaml;
  EXPECT_EQ(text.find("sensors"), std::string::npos);
  EXPECT_EQ(text.find("faults"), std::string::npos);
}

TEST(SensorSchema, MistakesInSensorsAreRefusedWithTheirRemedy)
{
  expectRefusals({
      {sensors("{kind: encoder}"), "sensors.0.name", "missing"},
      {sensors("{name: a}"), "sensors.0.kind", "missing"},
      {sensors("{name: a, kind: encodr}"), "sensors.0.kind", "encoder"},
      {sensors("{name: 1a, kind: encoder}"), "sensors.0.name", "letter first"},
      {sensors("{name: a, kind: encoder}, {name: a, kind: encoder}"), "sensors.1.name", "sensors.0"},
      {sensors("{name: a, kind: encoder, instrument: needle}"), "sensors.0.instrument", "it has wire"},
      {sensors("{name: a, kind: encoder, rate: 2000}"), "sensors.0.rate", "1/solver.time_step"},
      {sensors("{name: a, kind: encoder, rate: 0}"), "sensors.0.rate", "positive"},
      {sensors("{name: a, kind: encoder, delay: -1}"), "sensors.0.delay", ""},
      {sensors("{name: a, kind: encoder, drop_out: 1.5}"), "sensors.0.drop_out", "between 0 and 1"},
      {sensors("{name: a, kind: encoder, nois: {}}"), "nois", "noise"},
      {sensors("{name: a, kind: encoder, noise: {insertoin: 1e-3}}"), "sensors.0.noise", "insertion"},
      {sensors("{name: a, kind: encoder, noise: {insertion: -1e-3}}"), "sensors.0.noise.insertion", ""},
      {sensors("{name: a, kind: em_tracker, noise: {position: 2}}"), "sensors.0.noise.position", "2 mm = 0.002 m"},
      {sensors("{name: a, kind: em_tracker, bias: {position: 1e-3}}"), "sensors.0.bias.position", ""},
      {sensors("{name: a, kind: detector}"), "sensors.0.kind", "fluoroscopy"},
      {sceneText("fluoroscopy: {}\nsensors: [{name: a, kind: detector}]"), "sensors.0.kind", "fluoroscopy.isocentre"},
      {sceneText("sensors: 3"), "sensors", ""},
  });
}

TEST(SensorSchema, MistakesInFaultsAreRefusedWithTheirRemedy)
{
  expectRefusals({
      {faults("{kind: stuck}"), "faults.0.axis", "missing"},
      {faults("{axis: insertion}"), "faults.0.kind", "missing"},
      {faults("{axis: pressure, kind: stuck}"), "faults.0.axis", "insertion"},
      {faults("{axis: insertion, kind: stick}"), "faults.0.kind", "stuck"},
      {faults("{axis: insertion, kind: slipping}"), "faults.0.share", "missing"},
      {faults("{axis: insertion, kind: stuck, share: 0.5}"), "faults.0.share", "belongs to kind slipping"},
      {faults("{axis: insertion, kind: slipping, share: 1.5}"), "faults.0.share", "between 0 and 1"},
      {faults("{axis: insertion, kind: delayed, delay: 100}"), "faults.0.delay", "did you mean 100 ms"},
      {faults("{axis: insertion, kind: backlash, play: 0}"), "faults.0.play", "positive"},
      {faults("{axis: insertion, kind: stuck, start: 2, end: 1}"), "faults.0.end", "after the start"},
      {faults("{axis: insertion, kind: stuck, probability: 2}"), "faults.0.probability", "between 0 and 1"},
      {faults("{axis: insertion, kind: stuck, interval: 0}"), "faults.0.interval", "positive"},
      {faults("{axis: insertion, kind: stuck, instrument: needle}"), "faults.0.instrument", "it has wire"},
  });
}

TEST(SensorSchema, WithSeveralInstrumentsASensorNamesItsInstrument)
{
  const std::string text =
      "instruments:\n"
      "  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: topic}}\n"
      "  - {instrument: {use: catheter_6f_jl4, name: tube}, drive: {source: topic}}\n";
  const std::string message = refusalOf(text + "sensors: [{name: a, kind: encoder}]\n");
  EXPECT_NE(message.find("sensors.0.instrument"), std::string::npos) << message;
  const Scene scene = parseScene(text + "sensors: [{name: a, kind: encoder, instrument: tube}]\n", "s.yaml");
  EXPECT_EQ(scene.sensors.at(0).instrument, 1U);
}

}  // namespace
}  // namespace endovascular_sim::scene
