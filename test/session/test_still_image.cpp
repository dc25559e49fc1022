#include "session/still_image.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "scene/scene_file.h"
#include "session/session.h"

namespace endovascular_sim::session
{
namespace
{

/** Catheter in the natural anatomy, in a view of the heart without a body. */
std::shared_ptr<const World> catheter(std::vector<std::string> overrides)
{
  overrides.emplace_back(
      "fluoroscopy={pixels: 96, patient: none, follow_tip: false, isocentre: [0.03, -0.05, 0.16], "
      "detector_dose: 1e-6, max_air_kerma_rate: 1.0}");
  return World::open("catheter", overrides);
}

std::size_t changedPixels(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b)
{
  std::size_t changed = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    changed += std::abs(a[k] - b[k]) > 0.1 * b[k] ? 1U : 0U;
  return changed;
}

TEST(StillImage, ShowsTheVesselWhereTheHeartIs)
{
  Session moving(catheter({"motion=adult"})), resting(catheter({}));
  EXPECT_EQ(moving.image().raw, resting.image().raw);  // a run begins at rest
  moving.step(350);
  resting.step(350);
  EXPECT_GT(changedPixels(moving.image().raw, resting.image().raw), 100U);
  EXPECT_EQ(changedPixels(resting.image().raw, resting.image().raw), 0U);
}

TEST(StillImage, OfAMovingPatientIsAFunctionOfTheStateAlone)
{
  const auto world = catheter({"motion=adult"});
  Session whole(world), loaded(world);
  whole.step(100);
  whole.image();
  whole.step(150);
  const std::vector<std::uint16_t> first = whole.image().raw;
  EXPECT_EQ(whole.image().raw, first);
  loaded.load(whole.save());
  EXPECT_EQ(loaded.image().raw, first);
}

}  // namespace
}  // namespace endovascular_sim::session
