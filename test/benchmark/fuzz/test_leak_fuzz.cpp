#include "benchmark/fuzz/leak_fuzz.h"

#include <regex>

#include <gtest/gtest.h>

#include "benchmark/fuzz/fuzz_record.h"
#include "common/error.h"

namespace endovascular_sim::benchmark
{
namespace
{

FuzzSettings settings()
{
  FuzzSettings settings;
  settings.steps_per_episode = 150;
  return settings;
}

TEST(LeakFuzz, NoWireLeavesARandomChannel)
{
  FuzzVessels vessels({});
  double deepest = 0.0;
  for (std::uint64_t k = 0; k < 24; k += 2)  // every second kind of vessel is a channel
  {
    const FuzzEpisode episode = fuzzEpisode(vessels, settings(), k);
    ASSERT_EQ(episode.vessel, "channel");
    EXPECT_TRUE(episode.finite) << k;
    EXPECT_FALSE(episode.escaped) << k << ": " << episode.description;
    EXPECT_LE(episode.depth, kFuzzDepth) << k << ": " << episode.description;
    EXPECT_GE(episode.checks, 15);
    deepest = std::max(deepest, episode.depth);
  }
  EXPECT_GT(deepest, 1e-6);  // the wires touched walls
}

TEST(LeakFuzz, NoWireLeavesAMovingVessel)
{
  FuzzVessels vessels({});
  FuzzSettings moving = settings();
  moving.moving = true;
  moving.steps_per_episode = 400;
  for (std::uint64_t k = 0; k < 8; ++k)
  {
    const FuzzEpisode episode = fuzzEpisode(vessels, moving, k);
    EXPECT_TRUE(episode.finite) << k;
    EXPECT_FALSE(episode.escaped) << k << ": " << episode.description;
    EXPECT_LE(episode.depth, kFuzzDepth) << k << ": " << episode.description;
    EXPECT_GE(episode.checks, 40);
  }
}

// Stiff wires of which a few millimetres are in the vessel: their force snaps from one limit to the other within
// micrometres, so that no position of the hand is within its grip.
TEST(LeakFuzz, NoHandBearsMoreThanItsGripBesideASnap)
{
  FuzzVessels vessels({});
  FuzzSettings whole;
  for (const std::uint64_t k : {141, 280})
  {
    const FuzzEpisode episode = fuzzEpisode(vessels, whole, k);
    EXPECT_LE(episode.over_grips, kFuzzOverGrips) << k << ": " << episode.description;
    EXPECT_GT(episode.over_grips, 0.9) << k;
  }
}

TEST(LeakFuzz, AnEpisodeIsIndependentOfEarlierEpisodes)
{
  FuzzVessels vessels({});
  const FuzzEpisode first = fuzzEpisode(vessels, settings(), 6);
  fuzzEpisode(vessels, settings(), 2);
  const FuzzEpisode again = fuzzEpisode(vessels, settings(), 6);
  EXPECT_EQ(first.description, again.description);
  EXPECT_EQ(first.depth, again.depth);
  EXPECT_EQ(first.force, again.force);
}

TEST(FuzzRecord, ResumesFromItsJson)
{
  FuzzRecord record(settings(), {"channel"});
  FuzzEpisode episode;
  episode.vessel = "channel";
  episode.steps = 150;
  for (int k = 0; k < 30; ++k)
  {
    episode.number = static_cast<std::uint64_t>(k);
    episode.depth = 1e-6 * ((7 * k) % 30);
    record.add(episode);
  }
  FuzzRecord resumed(settings(), {"channel"});
  resumed.resume(record.json(), "state");
  EXPECT_EQ(resumed.json(), record.json());
  EXPECT_EQ(resumed.nextEpisode(), 30u);
  EXPECT_EQ(resumed.depth(), 29e-6);
  EXPECT_TRUE(resumed.good());
  episode.escaped = true;
  resumed.add(episode);
  EXPECT_FALSE(resumed.good());
  EXPECT_NE(resumed.csv().find("yes"), std::string::npos);
}

TEST(FuzzRecord, ResumesFromAFileWithTheKeysOfFormerVersions)
{
  FuzzRecord record(settings(), {"channel"});
  FuzzEpisode episode;
  episode.vessel = "channel";
  episode.checks = 12;
  episode.hit_iteration_limit = 3;
  record.add(episode);
  std::string former = std::regex_replace(record.json(), std::regex("\"checks\""), "\"looks\"");
  former = std::regex_replace(former, std::regex("\"hit_iteration_limit\""), "\"capped\"");
  EXPECT_NE(former, record.json());
  FuzzRecord resumed(settings(), {"channel"});
  resumed.resume(former, "state");
  EXPECT_EQ(resumed.json(), record.json());
}

TEST(FuzzRecord, RejectsResumptionWithOtherSettingsOrFromDamagedText)
{
  const std::string json = FuzzRecord(settings(), {"channel"}).json();
  FuzzSettings other = settings();
  other.seed = 2;
  FuzzRecord of_another_seed(other, {"channel"});
  EXPECT_THROW(of_another_seed.resume(json, "state"), InputError);
  FuzzRecord of_other_vessels(settings(), {"channel", "fork"});
  EXPECT_THROW(of_other_vessels.resume(json, "state"), InputError);
  FuzzRecord record(settings(), {"channel"});
  EXPECT_THROW(record.resume(json.substr(0, json.size() / 2), "state"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
