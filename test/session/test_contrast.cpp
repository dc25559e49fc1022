#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/text/format.h"
#include "session/session.h"
#include "session/x_ray_run.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

// Contrast medium in sessions: injections, iodine, images, saved states, procedures, results.

namespace endovascular_sim::session
{
namespace
{

const std::string kScene = TEST_DATA_DIR "/catheter_in_flow.yaml";

/** A catheter in an iliac artery of the natural anatomy, in flowing blood. */
std::shared_ptr<const World> catheter(const std::vector<std::string>& more = {})
{
  std::vector<std::string> overrides = {"contrast={}"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return World::open(kScene, overrides);
}

/** The same with a C-arm over the introducer. */
std::shared_ptr<const World> seenCatheter()
{
  const Eigen::Vector3d at = World::open(kScene)->entry().position;
  return catheter(
      {"fluoroscopy=" + formatted("{pixels: 128, patient: none, follow_tip: false, isocentre: [%g, %g, %g], "
                                  "detector_width: 0.2, view: AP, detector_dose: 1e-6, "
                                  "max_air_kerma_rate: 1.0}",
                                  at.x(), at.y(), at.z() + 0.03)});
}

contrast::Injection injection(const Session& session, double volume, double rate)
{
  return session.scene().contrast->injection(volume, rate, 0.2);
}

void expectEqual(const ContrastState& a, const ContrastState& b)
{
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.instruments, b.instruments);
  EXPECT_EQ(a.rate, b.rate);
  EXPECT_EQ(a.remaining, b.remaining);
  EXPECT_EQ(a.syringe, b.syringe);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.iodine.injected, b.iodine.injected);
  EXPECT_EQ(a.iodine.inside, b.iodine.inside);
  EXPECT_EQ(a.iodine.left, b.iodine.left);
}

TEST(Contrast, OfAnInjectionEntersTheVesselAndIsConserved)
{
  Session session(catheter());
  session.step(100);
  EXPECT_TRUE(session.observe().contrast()->cells.empty());
  session.inject(injection(session, 6e-6, 4e-6));
  double strongest = 0.0;
  for (int k = 0; k < 4000; ++k)
  {
    session.step();
    const ContrastState state = *session.observe().contrast();
    for (const double iodine : state.cells)
    {
      ASSERT_GE(iodine, 0.0);
      strongest = std::max(strongest, iodine);
    }
    ASSERT_NEAR(state.iodine.inside + state.iodine.left, state.iodine.injected, 1e-10 * state.iodine.injected);
    if (k == 800)
    {
      EXPECT_NEAR(state.rate, 4e-6, 1e-15);
      EXPECT_NEAR(state.volume + state.remaining, 6e-6, 1e-15);
    }
  }
  EXPECT_LE(strongest, 350.0 * (1.0 + 1e-9));
  EXPECT_GT(strongest, 50.0);
  const ContrastState state = *session.observe().contrast();
  EXPECT_NEAR(state.volume, 6e-6, 1e-15);
  EXPECT_NEAR(state.syringe, 6e-6, 1e-15);
  EXPECT_EQ(state.remaining, 0.0);
  EXPECT_NEAR(state.iodine.injected, 6e-6 * 350.0, 1e-10 * 6e-6 * 350.0);
  EXPECT_GT(state.iodine.left, 0.0);
  EXPECT_EQ(state.instruments, std::vector<double>{350.0}) << "the catheter holds 1.1 ml";
}

TEST(Contrast, WithoutAnInjectionLeavesTheTrajectoryAsItIs)
{
  Session with(catheter()), without(World::open(kScene));
  with.step(700);
  without.step(700);
  EXPECT_EQ(with.simulation().trajectoryHash(), without.simulation().trajectoryHash());
  EXPECT_EQ(with.observe().blood()->pressures, without.observe().blood()->pressures);
  EXPECT_EQ(with.observe().contrast()->iodine.injected, 0.0);
  EXPECT_FALSE(without.observe().contrast());
}

TEST(Contrast, ContinuesInTheMiddleOfAnInjectionBitForBit)
{
  const auto world = catheter();
  Session whole(world), saved(world), loaded(world);
  const int before = 713, after = 900;  // within a step of the flow
  for (Session* session : {&whole, &saved})
  {
    session->step(200);
    session->inject(injection(*session, 5e-6, 4e-6));
  }
  whole.step(before + after);
  saved.step(before);
  ASSERT_GT(saved.observe().contrast()->remaining, 0.0);
  const std::string state = saved.save();
  saved.step(after);
  loaded.load(state);
  EXPECT_GT(loaded.observe().contrast()->rate, 0.0);
  loaded.step(after);
  EXPECT_EQ(loaded.simulation().stateHash(), whole.simulation().stateHash());
  EXPECT_EQ(loaded.observe().blood()->pressures, whole.observe().blood()->pressures);
  expectEqual(*loaded.observe().contrast(), *whole.observe().contrast());
  expectEqual(*saved.observe().contrast(), *whole.observe().contrast());
  EXPECT_EQ(loaded.save(), whole.save());
}

TEST(Contrast, BeginsAgainAfterAReset)
{
  Session session(catheter());
  session.inject(injection(session, 5e-6, 4e-6));
  session.step(500);
  session.reset();
  EXPECT_EQ(session.observe().contrast()->syringe, 12e-6);
  session.step(500);
  EXPECT_TRUE(session.observe().contrast()->cells.empty());
  EXPECT_EQ(session.observe().contrast()->volume, 0.0);
}

TEST(Contrast, EndsWhenItIsStoppedAndWhenTheCatheterIsOut)
{
  Session stopped(catheter());
  stopped.inject(injection(stopped, 6e-6, 4e-6));
  stopped.step(500);
  stopped.stopInjection();
  stopped.step(500);
  const double given = stopped.observe().contrast()->volume;
  EXPECT_NEAR(given, 4e-6 * (0.5 - 0.1), 0.05e-6);
  EXPECT_NEAR(stopped.observe().contrast()->syringe, 12e-6 - given, 1e-15);
  EXPECT_NE(stopped.refusalOf(injection(stopped, 12e-6, 4e-6)).find("refill it"), std::string::npos);
  stopped.refillSyringe();
  EXPECT_EQ(stopped.refusalOf(injection(stopped, 12e-6, 4e-6)), "");

  Session withdrawn(catheter({"drive.initial_insertion=0.01", "drive.insertion={points: [[0, 0], [1, -0.01]]}"}));
  withdrawn.inject(injection(withdrawn, 6e-6, 2e-6));
  withdrawn.step(1500);
  EXPECT_EQ(withdrawn.observe().contrast()->remaining, 0.0);
  EXPECT_GT(withdrawn.observe().contrast()->volume, 1e-6);
  EXPECT_LT(withdrawn.observe().contrast()->volume, 2e-6);
  EXPECT_NE(withdrawn.refusalOf(injection(withdrawn, 1e-6, 1e-6)).find("no opening"), std::string::npos);
  EXPECT_THROW(withdrawn.inject(injection(withdrawn, 1e-6, 1e-6)), std::invalid_argument);
}

TEST(Contrast, IsRefusedInASceneWithoutIt)
{
  Session session(World::open(kScene));
  EXPECT_NE(session.refusalOf({6e-6, 4e-6, 0.3, 350.0, 0.01}).find("give it the key contrast"), std::string::npos);
  EXPECT_THROW(session.inject({6e-6, 4e-6, 0.3, 350.0, 0.01}), std::logic_error);
  EXPECT_THROW(session.stopInjection(), std::logic_error);
  EXPECT_THROW(session.refillSyringe(), std::logic_error);
}

/** Number of pixels that a second image has darker by a tenth. */
std::size_t darkerPixels(const std::vector<std::uint16_t>& before, const std::vector<std::uint16_t>& after)
{
  std::size_t darker = 0;
  for (std::size_t k = 0; k < before.size(); ++k)
    darker += after[k] < 0.9 * before[k] ? 1U : 0U;
  return darker;
}

TEST(Contrast, IsSeenInImages)
{
  const auto world = seenCatheter();
  Session plain(world), injected(world), loaded(world);
  injected.inject(injection(injected, 8e-6, 8e-6));
  plain.step(800);
  injected.step(800);
  const std::vector<std::uint16_t> without = plain.image().raw;
  const std::vector<std::uint16_t> with = injected.image().raw;
  EXPECT_GT(darkerPixels(without, with), 100U);
  EXPECT_LT(darkerPixels(with, without), 10U);
  loaded.load(injected.save());
  EXPECT_EQ(loaded.image().raw, with) << "a function of the state";
  EXPECT_EQ(injected.image().raw, with);
}

/** Raw frames of a run by their steps. */
std::map<std::uint64_t, std::vector<std::uint16_t>> framesOf(Session& session, XRayRun& run, std::uint64_t until)
{
  std::map<std::uint64_t, std::vector<std::uint16_t>> frames;
  for (;; session.step())
  {
    if (run.isDue(session.simulation()))
    {
      run.draw(session);
      frames[session.simulation().steps()] = run.frame().native.raw;
    }
    if (session.simulation().steps() >= until)
      return frames;
  }
}

TEST(Contrast, OfARunThatWasRestoredHasTheFramesOfTheWholeRun)
{
  const auto world = seenCatheter();
  Session whole(world), restored(world);
  XRayRun first(*world);
  framesOf(whole, first, 100);
  whole.inject(injection(whole, 6e-6, 6e-6));
  framesOf(whole, first, 450);
  const std::string state = whole.save();
  const auto frames = framesOf(whole, first, 800);
  restored.load(state);
  XRayRun second(*world);
  const auto others = framesOf(restored, second, 800);
  EXPECT_EQ(others.size(), 6U);
  for (const auto& [step, frame] : others)
    EXPECT_EQ(frame, frames.at(step)) << step;
  EXPECT_GT(darkerPixels(frames.begin()->second, frames.rbegin()->second), 10U) << "the vessel fills";
}

TEST(Contrast, IsInjectedByTheScene)
{
  Session session(catheter({"contrast={injections: [{at: 0.2, volume: 2 ml, rate: 4 ml/s}]}"}));
  session.step(200);
  EXPECT_EQ(session.observe().contrast()->volume, 0.0);
  session.step(10);
  EXPECT_GT(session.observe().contrast()->volume, 0.0);
  session.step(1000);
  EXPECT_NEAR(session.observe().contrast()->volume, 2e-6, 1e-15);
}

const std::string kSteps =
    "procedure={steps: [{wait: 0.1}, {inject: catheter, volume: 2 ml, rate: 4 ml/s}, {wait: 0.2}]}";

TEST(Contrast, IsInjectedByTheScriptedOperator)
{
  const auto world = catheter({kSteps});
  Session whole(world), loaded(world);
  whole.step(500);
  EXPECT_GT(whole.observe().contrast()->remaining, 0.0);
  EXPECT_EQ(whole.scriptedOperator()->records().size(), 2U);
  loaded.load(whole.save());
  for (Session* session : {&whole, &loaded})
    while (!session->isOver())
      session->step();
  EXPECT_EQ(whole.scriptedOperator()->progress(), procedure::Progress::kDone) << whole.scriptedOperator()->failure();
  EXPECT_NEAR(whole.observe().contrast()->volume, 2e-6, 1e-15) << "once";
  EXPECT_EQ(loaded.simulation().stateHash(), whole.simulation().stateHash());
  expectEqual(*loaded.observe().contrast(), *whole.observe().contrast());
}

TEST(Contrast, OfAPersonsStepCountsByItsVolume)
{
  Session session(catheter({kSteps, "procedure.guided=true", "drive.source=topic", "drive.insertion=null"}));
  session.step(1000);
  EXPECT_EQ(session.observe().contrast()->volume, 0.0) << "the operator does not inject";
  ASSERT_EQ(session.scriptedOperator()->records().size(), 2U);
  session.inject(injection(session, 1.5e-6, 4e-6));
  session.step(1000);
  EXPECT_EQ(session.scriptedOperator()->records().size(), 2U) << "not yet enough";
  session.inject(injection(session, 0.6e-6, 4e-6));
  session.step(1000);
  EXPECT_EQ(session.scriptedOperator()->records().size(), 3U);
}

TEST(Contrast, IsPartOfTheResults)
{
  SessionSettings settings;
  settings.results = true;
  Session session(catheter(), settings);
  session.inject(injection(session, 3e-6, 6e-6));
  session.step(1000);
  const TemporaryFolder folder;
  session.finish(folder.path());
  const auto result = nlohmann::json::parse(session.record().resultJson());
  EXPECT_NEAR(result["contrast"]["injected_volume"].get<double>(), 3e-6, 1e-15);
  EXPECT_NEAR(result["contrast"]["injected_iodine"].get<double>(), 3e-6 * 350.0, 1e-12);
  EXPECT_NEAR(result["contrast"]["inside"].get<double>() + result["contrast"]["left"].get<double>(), 3e-6 * 350.0,
              1e-12);
  EXPECT_EQ(result["contrast"]["missed_injections"], 0);
  EXPECT_EQ(nlohmann::json::parse(session.record().metrics()->json()["contrast"].dump()), result["contrast"]);
}

}  // namespace
}  // namespace endovascular_sim::session
