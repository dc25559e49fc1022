#include "rviz_plugin/model/scene_summary.h"

#include <gtest/gtest.h>

#include "scene/scene_file.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

SceneSummary summaryOf(const std::string& scene)
{
  SessionInfo info;
  info.scene_name = scene;
  info.scene_yaml = scene::loadScene(PROJECT_DIR "/config/scenes/" + scene + ".yaml", {}).resolved_yaml;
  return sceneSummary(info);
}

const InstrumentSummary& instrument(const SceneSummary& scene, const std::string& name)
{
  for (const InstrumentSummary& summary : scene.instruments)
    if (summary.shape.name == name)
      return summary;
  throw std::out_of_range(name);
}

TEST(SceneSummary, NamesTheInstrumentOfEachStep)
{
  const SceneSummary scene = summaryOf("lesson_lad_stent");
  ASSERT_EQ(scene.steps.size(), 19U);
  EXPECT_EQ(scene.steps[0].instrument, "wire");
  EXPECT_EQ(scene.steps[2].instrument, "catheter");
  EXPECT_EQ(scene.steps[9].instrument, "stent");
  EXPECT_FALSE(scene.steps[0].hint.empty());
  EXPECT_EQ(scene.steps[0].goal, "aortic_arch");
  EXPECT_EQ(scene.steps[3].goal, "") << "it leads out";
  EXPECT_EQ(scene.steps[9].goal, "left_anterior_descending") << "of the balloon";
}

TEST(SceneSummary, CountsAnExchangeAsTwoStepsAsTheProcedureDoes)
{
  const SceneSummary scene = summaryOf("pci");
  const auto parsed = scene::loadScene(PROJECT_DIR "/config/scenes/pci.yaml", {});
  std::size_t exchanges = 0;
  for (const scene::StepScene& step : parsed.procedure->steps)
    exchanges += step.action == scene::StepAction::kExchange ? 1 : 0;
  EXPECT_EQ(scene.steps.size(), parsed.procedure->steps.size() + exchanges);
}

TEST(SceneSummary, NamesInstrumentsThatCannotBeInsideTogether)
{
  const SceneSummary scene = summaryOf("lesson_lad_stent");
  EXPECT_EQ(instrument(scene, "wire").conflicts, (std::vector<std::string>{"soft_wire", "stent"}));
  EXPECT_EQ(instrument(scene, "soft_wire").conflicts, std::vector<std::string>{"wire"});
  EXPECT_TRUE(instrument(scene, "catheter").conflicts.empty());
}

TEST(SceneSummary, KnowsTheEndOfAnInstrumentAndItsBalloon)
{
  const SceneSummary scene = summaryOf("lesson_lad_stent");
  const InstrumentSummary& wire = instrument(scene, "wire");
  EXPECT_NEAR(wire.length, 0.8, 1e-9);
  EXPECT_NEAR(wire.largest_insertion, 0.8 - 0.019 - 3 * 0.004, 1e-9);
  EXPECT_NEAR(wire.outside_insertion, -0.019 - 2 * 0.004, 1e-9);
  const InstrumentSummary& stent = instrument(scene, "stent");
  EXPECT_TRUE(stent.has_balloon);
  EXPECT_GT(stent.balloon.nominalDiameter(), 2e-3);
  EXPECT_GT(stent.balloon.rated_burst_pressure, stent.balloon.nominal_pressure);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
