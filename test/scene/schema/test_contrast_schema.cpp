#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "test/common/input_error_of.h"

// Contrast medium in scenes: key `contrast`, side holes, steps that inject.

namespace endovascular_sim::scene
{
namespace
{

const std::string kFlow = TEST_DATA_DIR "/catheter_in_flow.yaml";
const std::string kTwo = PROJECT_DIR "/config/scenes/catheter.yaml";  // wire and catheter

Scene with(std::vector<std::string> overrides)
{
  return loadScene(kFlow, overrides);
}

std::string refusal(const std::string& scene, const std::vector<std::string>& overrides)
{
  return inputErrorOf([&] { loadScene(scene, overrides); });
}

void expectRefusal(const std::string& scene, const std::vector<std::string>& overrides, const std::string& key,
                   const std::string& remedy)
{
  const std::string message = refusal(scene, overrides);
  EXPECT_NE(message.find(": " + key), std::string::npos) << message;
  EXPECT_NE(message.find(remedy), std::string::npos) << message;
}

TEST(ContrastSchema, AnEmptyMapHasTheUsualMediumInAHandSyringe)
{
  const Scene scene = with({"contrast={}"});
  ASSERT_TRUE(scene.contrast);
  EXPECT_EQ(scene.contrast->instrument, "catheter");
  EXPECT_EQ(scene.contrast->concentration, 350.0);
  EXPECT_EQ(scene.contrast->viscosity, 10.4e-3);
  EXPECT_EQ(scene.contrast->syringe().capacity, contrast::kHandSyringe.capacity);
  EXPECT_TRUE(scene.contrast->injections.empty());
  EXPECT_EQ(scene.injectingInstrument(), 0U);
  EXPECT_EQ(loadScene(kTwo, {"flow=adult", "contrast={}"}).injectingInstrument(), 1U) << "a wire has no lumen";
}

TEST(ContrastSchema, IsReadFromItsOwnText)
{
  const Scene scene =
      with({"contrast={concentration: 300, syringe: pump, injections: [{at: 1, volume: 15 ml, rate: 15 ml/s, rise: "
            "0.5}, {at: 3, volume: 1 cm³, rate: 60 ml/min}]}",
            "fluoroscopy={}"});
  const Scene again = parseScene(scene.resolved_yaml, "again.yaml");
  EXPECT_EQ(again.resolved_yaml, scene.resolved_yaml);
  ASSERT_EQ(again.contrast->injections.size(), 2U);
  EXPECT_EQ(again.contrast->injections[0].volume, scene.contrast->injections[0].volume);
  EXPECT_DOUBLE_EQ(again.contrast->injections[0].volume, 15e-6);
  EXPECT_EQ(again.contrast->injections[0].rise, 0.5);
  EXPECT_DOUBLE_EQ(again.contrast->injections[1].volume, 1e-6);
  EXPECT_NEAR(again.contrast->injections[1].rate, 1e-6, 1e-18);
  EXPECT_EQ(again.contrast->injections[1].rise, 0.3);
  EXPECT_EQ(again.contrast->viscosity, 6.3e-3) << "of iohexol with 300 mgI/ml";
  EXPECT_EQ(again.contrast->syringe().capacity, contrast::kPumpSyringe.capacity);
}

TEST(ContrastSchema, TakesThePlaceOfEvenIodine)
{
  EXPECT_EQ(with({"fluoroscopy={}"}).fluoroscopy->iodine, 150.0);
  EXPECT_EQ(with({"fluoroscopy={}", "contrast={}"}).fluoroscopy->iodine, 0.0);
  EXPECT_EQ(with({"fluoroscopy={iodine: 0}", "contrast={}"}).fluoroscopy->iodine, 0.0);
  expectRefusal(kFlow, {"fluoroscopy={iodine: 150}", "contrast={}"}, "fluoroscopy.iodine", "remove it, or contrast");
  EXPECT_EQ(with({}).resolved_yaml.find("contrast"), std::string::npos);
}

TEST(ContrastSchema, AnotherMediumHasAViscosityOfItsOwn)
{
  const Scene scene = with({"contrast={viscosity: 0.009}"});
  EXPECT_EQ(scene.contrast->injection(1e-6, 2e-6, 0.1).viscosity, 0.009);
  EXPECT_EQ(scene.contrast->injection(1e-6, 2e-6, 0.1).concentration, 350.0);
  EXPECT_EQ(scene.contrast->injection(1e-6, 2e-6, 0.1, 140.0).viscosity, 1.5e-3);
}

TEST(ContrastSchema, RefusesAnInstrumentThatCannotInject)
{
  expectRefusal(kTwo, {"flow=adult", "contrast={instrument: needle}"}, "contrast.instrument",
                "has no instrument 'needle'; name one with a lumen");
  expectRefusal(kTwo, {"flow=adult", "contrast={instrument: wire}"}, "contrast.instrument",
                "'wire' has no lumen; name a catheter");
  expectRefusal(kFlow, {"instrument={use: guidewire_035_j}", "contrast={}"}, "contrast",
                "no instrument of the scene has a lumen");
}

TEST(ContrastSchema, RefusesInjectionsThatOverlapOrHaveNothingInside)
{
  const std::string first = "{at: 1, volume: 4 ml, rate: 4 ml/s, rise: 0.4}";  // ends at 2.2 s
  EXPECT_EQ(refusal(kFlow, {"contrast={injections: [" + first + ", {at: 2.3, volume: 1 ml, rate: 1 ml/s}]}"}), "");
  expectRefusal(kFlow, {"contrast={injections: [" + first + ", {at: 2.1, volume: 1 ml, rate: 1 ml/s}]}"},
                "contrast.injections.1.at", "before the end of the injection before, 2.2 s; give a later time");
  expectRefusal(kFlow, {"contrast={injections: [" + first + ", {at: 0, volume: 1 ml, rate: 1 ml/s}]}"},
                "contrast.injections.1.at", "give a later time");
  expectRefusal(kTwo, {"flow=adult", "contrast={injections: [" + first + "]}"}, "contrast.injections.0.at",
                "'catheter' is outside of the vessel at 1 s");
}

TEST(ContrastSchema, AStepOfAProcedureInjects)
{
  const std::string procedure = "procedure={steps: [{inject: catheter, volume: 3 ml, rate: 3 ml/s, hint: look}]}";
  const Scene scene = with({"contrast={}", procedure});
  const StepScene& step = scene.procedure->steps.front();
  EXPECT_EQ(step.action, StepAction::kInject);
  EXPECT_EQ(step.instrument, "catheter");
  EXPECT_EQ(step.volume, 3e-6);
  EXPECT_EQ(step.rise, 0.3);
  EXPECT_EQ(parseScene(scene.resolved_yaml, "again.yaml").resolved_yaml, scene.resolved_yaml);
  expectRefusal(kFlow, {procedure}, "procedure.steps.0.inject",
                "needs contrast medium; give the scene the key contrast");
  expectRefusal(kFlow, {"contrast={}", "procedure={steps: [{inject: wire, volume: 3 ml, rate: 3 ml/s}]}"},
                "procedure.steps.0.inject", "'wire' does not inject; name 'catheter'");
  expectRefusal(kFlow, {"contrast={}", "procedure={steps: [{inject: catheter, volume: 20 ml, rate: 3 ml/s}]}"},
                "procedure.steps.0.volume", "the hand syringe holds 12 ml");
  expectRefusal(kFlow, {"contrast={}", "procedure={steps: [{inject: catheter, volume: 3 ml}]}"},
                "procedure.steps.0.rate", "missing");
}

TEST(ContrastSchema, InstrumentsHaveSideHoles)
{
  const Scene pigtail = with({"instrument={use: catheter_5f_pigtail, name: catheter}"});
  ASSERT_TRUE(pigtail.instruments[0].instrument.side_holes);
  const std::vector<double> openings = instrument::openingsOf(pigtail.instruments[0].instrument);
  ASSERT_EQ(openings.size(), 11U);
  EXPECT_EQ(openings[0], 0.0);
  EXPECT_EQ(openings[1], 0.03);
  EXPECT_NEAR(openings[10], 0.057, 1e-12);
  EXPECT_EQ(parseScene(pigtail.resolved_yaml, "again.yaml").resolved_yaml, pigtail.resolved_yaml);
  const instrument::Instrument plain = with({}).instruments[0].instrument;
  EXPECT_EQ(instrument::openingsOf(plain), std::vector<double>{0.0});
  EXPECT_EQ(with({"instrument.side_holes={count: 2, spacing: 5 mm}"}).instruments[0].instrument.side_holes->from_tip,
            5e-3);
  expectRefusal(kFlow, {"instrument.side_holes={count: 100, spacing: 0.05}"}, "instrument.side_holes.count",
                "beyond the shaft; give fewer");
}

}  // namespace
}  // namespace endovascular_sim::scene
