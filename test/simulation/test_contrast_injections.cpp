#include "simulation/contrast_injections.h"

#include <gtest/gtest.h>

#include "common/archive.h"
#include "scene/scene_file.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kStep = 5e-3;  // of the flow [s]

scene::Scene with(std::vector<std::string> overrides)
{
  return scene::loadScene(TEST_DATA_DIR "/catheter_in_flow.yaml", overrides);
}

/** Path along one branch, from the tip at @p arc towards its beginning. */
std::function<flow::TreePath()> pathFrom(double arc)
{
  return [arc] { return flow::TreePath({{3, arc, 0.0}}); };
}

double sharesOf(const flow::FlowInjection& injection)
{
  double sum = 0.0;
  for (const flow::FlowOpening& opening : injection.openings)
    sum += opening.share;
  return sum;
}

TEST(ContrastInjections, GiveTheVolumeOfAnInjectionInStepsOfTheFlow)
{
  const scene::Scene scene = with({"contrast={}"});
  ContrastInjections injections(scene);
  EXPECT_EQ(injections.advance(0.0, {0.1}, pathFrom(0.1)).volume, 0.0);
  const contrast::Injection wanted = scene.contrast->injection(2e-6, 4e-6, 0.2);
  EXPECT_EQ(injections.refusalOf(wanted, false, {0.1}), "");
  injections.follow({7, wanted, false});
  double sum = 0.0;
  int steps = 0;
  for (; injections.injector().isActive(); ++steps)
  {
    const flow::FlowInjection injection = injections.advance(kStep * steps, {0.1}, pathFrom(0.1));
    sum += injection.volume;
    ASSERT_GT(injection.volume, 0.0);
    ASSERT_LE(injections.rate(), 4e-6 * (1.0 + 1e-12));
    ASSERT_EQ(injection.openings.size(), 1U);
    ASSERT_EQ(injection.openings[0].place.branch, 3);
    ASSERT_EQ(injection.openings[0].place.arc, 0.1);
    ASSERT_EQ(injection.viscosity, 10.4e-3);
  }
  EXPECT_NEAR(sum, 2e-6, 1e-18);
  EXPECT_EQ(injections.injectedVolume(), sum);
  EXPECT_EQ(steps, 120) << "0.2 s of rise, then 0.4 s";
  EXPECT_NEAR(injections.injector().content(), 10e-6, 1e-18);
  EXPECT_EQ(injections.advance(1.0, {0.1}, pathFrom(0.1)).volume, 0.0);
  EXPECT_EQ(injections.rate(), 0.0);
}

TEST(ContrastInjections, LeaveThroughTheOpeningsInTheVessel)
{
  const scene::Scene scene =
      with({"instrument={use: catheter_5f_pigtail, name: catheter}", "contrast={syringe: pump}"});
  ContrastInjections injections(scene);
  injections.follow({0, scene.contrast->injection(20e-6, 15e-6, 0.0), false});
  const flow::FlowInjection all = injections.advance(0.0, {0.1}, pathFrom(0.1));
  EXPECT_EQ(all.openings.size(), 11U);
  EXPECT_NEAR(all.openings[1].place.arc, 0.07, 1e-12) << "30 mm from the tip";
  EXPECT_NEAR(sharesOf(all), 11.0 * all.openings[0].share, 1e-12) << "equal parts";
  const flow::FlowInjection some = injections.advance(kStep, {0.034}, pathFrom(0.034));
  EXPECT_EQ(some.openings.size(), 3U) << "end, and holes at 30 and 33 mm";
  EXPECT_NEAR(some.volume, 15e-6 * kStep, 1e-18) << "all of it through these";
}

TEST(ContrastInjections, LeaveNothingIntoAnOuterInstrument)
{
  const scene::Scene scene = scene::loadScene(
      PROJECT_DIR "/config/scenes/catheter.yaml",
      {"flow=adult", "instruments.0.instrument={use: microcatheter, name: micro}", "contrast={instrument: micro}"});
  ContrastInjections injections(scene);
  const contrast::Injection wanted = scene.contrast->injection(2e-6, 1e-6, 0.0);
  EXPECT_EQ(injections.refusalOf(wanted, false, {0.20, 0.15}), "");
  for (const std::vector<double>& hidden : {std::vector<double>{0.15, 0.20}, {0.0, -0.1}, {-0.05, -0.1}})
    EXPECT_NE(injections.refusalOf(wanted, false, hidden).find("no opening of 'micro' is in the vessel"),
              std::string::npos);
  injections.follow({0, wanted, false});
  EXPECT_GT(injections.advance(0.0, {0.20, 0.15}, pathFrom(0.2)).volume, 0.0);
  EXPECT_EQ(injections.advance(kStep, {0.20, 0.25}, pathFrom(0.2)).volume, 0.0);
  EXPECT_FALSE(injections.injector().isActive()) << "it ends";
  EXPECT_NEAR(injections.injector().content(), 12e-6 - kStep * 1e-6, 1e-18) << "the rest stays in the syringe";
}

TEST(ContrastInjections, RefuseASecondOneAndMoreThanTheSyringeHolds)
{
  const scene::Scene scene = with({"contrast={}"});
  ContrastInjections injections(scene);
  const contrast::Injection large = scene.contrast->injection(8e-6, 4e-6, 0.3);
  injections.follow({0, large, false});
  EXPECT_NE(injections.refusalOf(scene.contrast->injection(1e-6, 4e-6, 0.3), false, {0.1}).find("8 ml of the present"),
            std::string::npos);
  for (int k = 0; injections.injector().isActive(); ++k)
    injections.advance(kStep * k, {0.1}, pathFrom(0.1));
  const std::string refusal = injections.refusalOf(large, false, {0.1});
  EXPECT_NE(refusal.find("the hand syringe holds 4 ml; inject less, or refill it"), std::string::npos) << refusal;
  EXPECT_THROW(injections.follow({3, large, false}), std::invalid_argument);
  EXPECT_EQ(injections.refusalOf(large, true, {0.1}), "");
  injections.follow({3, large, true});
  EXPECT_EQ(injections.injector().content(), 12e-6);
}

TEST(ContrastInjections, KnowTheInputsOfTheNewestStep)
{
  const scene::Scene scene = with({"contrast={}"});
  ContrastInjections injections(scene);
  injections.follow({4, {}, true});
  injections.follow({4, scene.contrast->injection(1e-6, 1e-6, 0.0), false});
  ASSERT_EQ(injections.inputs().size(), 2U);
  EXPECT_TRUE(injections.inputs()[0].refill);
  EXPECT_EQ(injections.inputs()[1].injection.volume, 1e-6);
  injections.follow({5, {}, false});
  ASSERT_EQ(injections.inputs().size(), 1U);
  EXPECT_EQ(injections.inputs()[0].step, 5U);
  EXPECT_FALSE(injections.injector().isActive());
  EXPECT_EQ(injections.injector().content(), 12e-6);
}

TEST(ContrastInjections, OfTheSceneBeginAtTheirTimesWithAFilledSyringe)
{
  const scene::Scene scene =
      with({"contrast={injections: [{at: 0.5, volume: 7 ml, rate: 7 ml/s}, {at: 3, volume: 7 ml, rate: 7 ml/s}]}"});
  ContrastInjections injections(scene);
  double first = -1.0;
  for (int k = 0; k < 1000; ++k)
    if (injections.advance(kStep * k, {0.1}, pathFrom(0.1)).volume > 0.0 && first < 0.0)
      first = kStep * k;
  EXPECT_NEAR(first, 0.5, 1e-12);
  EXPECT_NEAR(injections.injectedVolume(), 14e-6, 1e-16);
  EXPECT_NEAR(injections.injector().content(), 5e-6, 1e-16);
  EXPECT_TRUE(injections.inputs().empty()) << "they are part of the scene";
  EXPECT_EQ(injections.missed(), 0);
  ContrastInjections outside(scene);
  for (int k = 0; k < 1000; ++k)
    ASSERT_EQ(outside.advance(kStep * k, {0.0}, pathFrom(0.0)).volume, 0.0);
  EXPECT_EQ(outside.missed(), 2);
}

TEST(ContrastInjections, FillTheLumenOnceItsVolumeHasPassed)
{
  const scene::Scene scene = with({"contrast={}"});
  const instrument::Instrument& catheter = scene.instruments[0].instrument;
  const double dead = M_PI * catheter.inner_radius * catheter.inner_radius * catheter.wire.length();
  ContrastInjections injections(scene);
  injections.follow({0, scene.contrast->injection(5e-6, 1e-6, 0.0), false});
  for (int k = 0; injections.injector().isActive(); ++k)
  {
    injections.advance(kStep * k, {0.1}, pathFrom(0.1));
    ASSERT_EQ(injections.lumens()[0], injections.injectedVolume() >= dead ? 350.0 : 0.0);
  }
  EXPECT_EQ(injections.lumens()[0], 350.0);
  injections.follow({9, scene.contrast->injection(0.5e-6, 1e-6, 0.0, 140.0), true});
  while (injections.injector().isActive())
    injections.advance(9.0, {0.1}, pathFrom(0.1));
  EXPECT_EQ(injections.lumens()[0], 350.0) << "half a millilitre of another medium does not fill it";
}

TEST(ContrastInjections, ContinueFromAnArchive)
{
  const scene::Scene scene = with({"contrast={injections: [{at: 1, volume: 2 ml, rate: 3 ml/s}]}"});
  ContrastInjections whole(scene);
  for (int k = 0; k < 250; ++k)
    whole.advance(kStep * k, {0.1}, pathFrom(0.1));
  ASSERT_TRUE(whole.injector().isActive());
  Archive saved;
  whole.archive(saved);
  ContrastInjections loaded(scene);
  Archive reading(saved.bytes());
  loaded.archive(reading);
  EXPECT_TRUE(reading.atEnd());
  EXPECT_EQ(loaded.rate(), whole.rate());
  for (int k = 250; k < 500; ++k)
    ASSERT_EQ(loaded.advance(kStep * k, {0.1}, pathFrom(0.1)).volume,
              whole.advance(kStep * k, {0.1}, pathFrom(0.1)).volume);
  EXPECT_EQ(loaded.injectedVolume(), whole.injectedVolume());
  EXPECT_EQ(loaded.injector().content(), whole.injector().content());
  const scene::Scene without = with({"contrast={}"});
  ContrastInjections other(without);
  Archive again(saved.bytes());
  EXPECT_THROW(other.archive(again), ArchiveError) << "it has no injection that has begun";
}

}  // namespace
}  // namespace endovascular_sim::simulation
