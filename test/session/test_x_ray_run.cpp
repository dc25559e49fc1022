#include "session/x_ray_run.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <stdexcept>

#include "fluoroscopy/gantry/view.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::session
{
namespace
{

/** Catheter in the natural anatomy whose heart beats, with the body or a slab around it. */
std::shared_ptr<const World> catheter(const std::string& patient = "none")
{
  return World::open("catheter", {"motion=adult", "fluoroscopy={pixels: 96, patient: " + patient +
                                                      ", follow_tip: false, isocentre: [0.03, -0.05, 0.16], "
                                                      "view: RAO 30 CAU 20}"});
}

struct Images
{
  std::vector<std::uint16_t> raw;
  std::vector<std::uint8_t> image, subtracted;
  bool operator==(const Images& other) const
  {
    return raw == other.raw && image == other.image && subtracted == other.subtracted;
  }
};

Images imagesOf(const fluoroscopy::AngiographyFrame& frame)
{
  return {frame.native.raw, frame.native.image, frame.subtracted};
}

/** Frames of a run by their steps.
 *  @param left_out pulses that are not drawn */
std::map<std::uint64_t, Images> framesOf(Session& session, XRayRun& run, std::uint64_t until,
                                         const std::function<bool(std::uint64_t)>& left_out = {})
{
  std::map<std::uint64_t, Images> frames;
  while (true)
  {
    const std::uint64_t steps = session.simulation().steps();
    if (run.isDue(session.simulation()) && !(left_out && left_out(run.pulses().newestAt(steps))))
    {
      run.draw(session);
      frames[steps] = imagesOf(run.frame());
    }
    if (steps >= until)
      return frames;
    session.step();
  }
}

TEST(XRayRun, HasItsFramesAtTheStepsOfThePulses)
{
  const auto world = catheter();
  Session session(world);
  XRayRun run(*world);
  std::vector<std::uint64_t> steps;
  for (const auto& [step, images] : framesOf(session, run, 300))
    steps.push_back(step);
  EXPECT_EQ(steps, (std::vector<std::uint64_t>{0, 67, 134, 200, 267}));
  EXPECT_THROW(run.draw(session), std::logic_error);
}

TEST(XRayRun, AFrameHasEqualBitsWhenEverySecondOneIsLeftOut)
{
  const auto world = catheter("{body: true}");
  Session whole(world), sparse(world);
  XRayRunSettings settings;
  settings.mask_frames = 2;
  XRayRun all(*world, settings), some(*world, settings);
  const auto frames = framesOf(whole, all, 900);
  const auto others = framesOf(sparse, some, 900, [](std::uint64_t pulse) { return pulse > 1 && pulse % 2 == 1; });
  EXPECT_EQ(frames.size(), 14U);
  EXPECT_EQ(others.size(), 8U);
  for (const auto& [step, images] : others)
    EXPECT_TRUE(images == frames.at(step)) << step;
  EXPECT_FALSE(frames.at(400).subtracted.empty());
  EXPECT_FALSE(frames.at(400) == frames.at(467));  // the heart beats
}

TEST(XRayRun, OfARestoredStateEqualsThatOfTheWholeRun)
{
  const auto world = catheter();
  Session whole(world);
  XRayRun first(*world);
  framesOf(whole, first, 250);
  const std::string state = whole.save();
  const auto frames = framesOf(whole, first, 600);
  Session restored(world);
  restored.load(state);
  XRayRun second(*world);
  const auto others = framesOf(restored, second, 600);
  EXPECT_EQ(others.size(), 6U);
  for (const auto& [step, images] : others)
    EXPECT_TRUE(images == frames.at(step)) << step;
}

TEST(XRayRun, BiplaneImagesEqualTwoSinglePlaneOnesAtTheSamePulse)
{
  const auto world = catheter();
  Session session(world);
  session.step(400);
  XRayRunSettings both;
  both.views = {"RAO 30 CAU 20", "LAO 40"};
  XRayRun biplane(*world, both);
  biplane.draw(session);
  ASSERT_EQ(biplane.detectors(), 2U);
  XRayRun frontal(*world);
  frontal.draw(session);
  EXPECT_TRUE(imagesOf(biplane.frame(0)) == imagesOf(frontal.frame()));
  EXPECT_EQ(biplane.frame(0).pulse, biplane.frame(1).pulse);
  // The second detector has noise of its own.
  simulation::FluoroscopySystem system(world->scene(),
                                       fluoroscopy::MaterialLibrary::load(PROJECT_DIR "/config/xray/materials.yaml"));
  fluoroscopy::CArmPose pose = system.fluoroscope().geometry().pose();
  pose.primary_angle = fluoroscopy::parseView("LAO 40")->primary_angle;
  pose.secondary_angle = 0.0;
  system.fluoroscope().setPose(pose);
  system.fluoroscope().setVessel(session.wall());
  system.setHeart(session.simulation().motion()->patient().map().frame());
  system.fluoroscope().setMotion(simulation::bodyMotion(session.simulation()));
  fluoroscopy::Angiography lateral(system.fluoroscope(), 1);
  EXPECT_TRUE(imagesOf(biplane.frame(1)) == imagesOf(lateral.draw(6, system.wires(session.simulation()))));
}

TEST(XRayRun, ShowsTheRoadmapOfItsDsaRunFromItsTimeOn)
{
  const auto world = catheter("{body: true}");
  Session session(world), same(world), other(world);
  XRayRunSettings settings;
  XRayRun plain(*world, settings);
  settings.mask_frames = 1;
  XRayRun subtracted(*world, settings);
  settings.roadmap_at = 0.25;
  XRayRun run(*world, settings);
  const auto frames = framesOf(session, run, 300), without = framesOf(same, subtracted, 300),
             live = framesOf(other, plain, 300);
  EXPECT_EQ(run.frame().mode, fluoroscopy::XRayMode::kRoadmap);
  EXPECT_EQ(run.frame().mask, fluoroscopy::MaskState::kValid);
  EXPECT_TRUE(frames.at(200) == without.at(200));
  EXPECT_FALSE(frames.at(200).subtracted.empty());
  EXPECT_TRUE(frames.at(267).subtracted.empty());
  EXPECT_FALSE(frames.at(267).image == live.at(267).image) << "the roadmap lies over the image";
  EXPECT_TRUE(frames.at(267).raw == live.at(267).raw);
}

TEST(XRayRun, RefusesWhatIsImpossible)
{
  const auto world = catheter();
  const auto refusal = [&](const std::vector<std::string>& views, int mask_frames) {
    return inputErrorOf([&] { XRayRun(*world, {views, mask_frames, {0.0, 0.0}, {}}); });
  };
  EXPECT_NE(refusal({}, 0).find("give one, or two of a biplane system"), std::string::npos);
  EXPECT_NE(refusal({"AP", "LAO 30", "RAO 30"}, 0).find("has 3 views"), std::string::npos);
  EXPECT_NE(refusal({"sipder"}, 0).find("unknown view 'sipder'"), std::string::npos);
  EXPECT_NE(refusal({""}, 65).find("mask_frames"), std::string::npos);
  EXPECT_NE(inputErrorOf(
                [&] {
                  XRayRun(*world, {{""}, 0, {0.0, 0.0}, 1.0});
                })
                .find("needs a run of DSA"),
            std::string::npos);
  const auto blind = World::open("tube", {"fluoroscopy=none"});
  EXPECT_NE(inputErrorOf([&] { XRayRun run(*blind); }).find("fluoroscopy"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::session
