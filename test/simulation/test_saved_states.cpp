#include <cstring>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "common/hash.h"
#include "common/version.h"
#include "test/common/input_error_of.h"
#include "test/fuzz/fuzz_simulation.h"
#include "test/simulation/treatment_bench.h"

// States that a simulation saves and loads.

namespace endovascular_sim::simulation
{
namespace
{

const std::string kStentScene = PROJECT_DIR "/config/scenes/stent.yaml";  // two instruments, adaptive sampling, balloon
const std::string kAdaptive = "sampling={kind: adaptive}";

std::string save(TreatmentBench& bench)
{
  std::ostringstream stream;
  bench.simulation.save(stream, 7);
  return stream.str();
}

void load(TreatmentBench& bench, const std::string& state)
{
  std::istringstream stream(state);
  bench.simulation.load(stream, 7);
}

std::vector<std::string> statesAt(TreatmentBench& bench, const std::vector<double>& moments)
{
  std::vector<std::string> states;
  for (const double moment : moments)
  {
    bench.runTo(moment);
    states.push_back(save(bench));
  }
  return states;
}

/** Expects that every state, loaded into a new simulation, continues as the uninterrupted run. */
void expectContinuation(const std::string& scene, const std::vector<double>& moments, double end)
{
  TreatmentBench whole({}, scene);
  const std::vector<std::string> states = statesAt(whole, moments);
  whole.runTo(end);
  for (const std::string& state : states)
  {
    TreatmentBench resumed({}, scene);
    load(resumed, state);
    const double begin = resumed.simulation.time();
    resumed.runTo(end);
    EXPECT_EQ(resumed.simulation.trajectoryHash(), whole.simulation.trajectoryHash()) << "from " << begin << " s";
    EXPECT_EQ(resumed.simulation.events().size(), whole.simulation.events().size());
  }
}

/** Expects the same of one simulation that loads all states, the last one first, twice each. */
void expectContinuationAfterSteps(const std::string& scene, const std::vector<double>& moments, double end,
                                  const std::vector<std::string>& overrides = {})
{
  TreatmentBench bench(overrides, scene);
  const std::vector<std::string> states = statesAt(bench, moments);
  bench.runTo(end);
  const std::uint64_t hash = bench.simulation.trajectoryHash();
  const std::string last = save(bench);
  for (auto state = states.rbegin(); state != states.rend(); ++state)
  {
    load(bench, *state);
    load(bench, *state);
    const double begin = bench.simulation.time();
    bench.runTo(end);
    EXPECT_EQ(bench.simulation.trajectoryHash(), hash) << "from " << begin << " s";
    EXPECT_EQ(save(bench), last) << "from " << begin << " s";
  }
}

TEST(SavedStates, OfABalloonContinueBitForBitFromEveryPhase)
{
  expectContinuation(TEST_DATA_DIR "/scenes/good_inflation.yaml", {0.05, 0.4, 1.0, 2.3, 3.6}, 3.8);
}

TEST(SavedStates, OfSeveralInstrumentsWithAdaptiveSamplingContinueBitForBit)
{
  // While the system passes the wire's nodes, and while its balloon opens the lesion.
  expectContinuation(kStentScene, {4.0, 6.0}, 6.2);
}

TEST(SavedStates, OfAUniformWireLoadAfterStepsAndTwice)
{
  expectContinuationAfterSteps(PROJECT_DIR "/config/scenes/tube.yaml", {0.0, 0.1, 0.4}, 0.6);
}

TEST(SavedStates, OfAWireWithAdaptiveSamplingLoadAfterStepsAndTwice)
{
  expectContinuationAfterSteps(PROJECT_DIR "/config/scenes/demo.yaml", {0.0, 0.5, 1.0}, 1.2, {kAdaptive});
}

TEST(SavedStates, OfABalloonLoadAfterStepsAndTwice)
{
  expectContinuationAfterSteps(TEST_DATA_DIR "/scenes/good_inflation.yaml", {0.1, 1.0, 2.3}, 2.5);
}

TEST(SavedStates, OfSeveralInstrumentsLoadAfterStepsAndTwice)
{
  expectContinuationAfterSteps(kStentScene, {0.5, 5.0}, 5.1);
}

TEST(SavedStates, LoadOverASimulationWithoutSampling)
{
  TreatmentBench bench({kAdaptive}, PROJECT_DIR "/config/scenes/demo.yaml");
  const std::string first = save(bench);
  bench.runTo(0.3);
  const std::uint64_t hash = bench.simulation.trajectoryHash();
  bench.simulation.keepSampling();
  bench.runTo(0.4);
  load(bench, first);
  bench.runTo(0.3);
  EXPECT_EQ(bench.simulation.trajectoryHash(), hash);
}

std::string refusalOf(TreatmentBench& bench, const std::string& state, std::uint64_t vessel_hash = 7)
{
  return inputErrorOf(
      [&]
      {
        std::istringstream stream(state);
        bench.simulation.load(stream, vessel_hash, "a.state");
      });
}

TEST(SavedStates, ThatAreDamagedOrOfAnotherSceneAreRefused)
{
  TreatmentBench bench;
  bench.runTo(0.02);
  const std::string state = save(bench);
  TreatmentBench fresh;
  EXPECT_NE(refusalOf(fresh, "").find("a.state: is not a saved state"), std::string::npos);
  EXPECT_NE(refusalOf(fresh, state.substr(0, state.size() / 2)).find("damaged or cut off"), std::string::npos);
  for (const std::size_t byte : {std::size_t{9}, state.size() / 3, state.size() - 1})
  {
    std::string garbled = state;
    garbled[byte] = static_cast<char>(garbled[byte] ^ 1);
    EXPECT_NE(refusalOf(fresh, garbled).find("damaged or cut off"), std::string::npos) << "byte " << byte;
  }
  EXPECT_NE(refusalOf(fresh, state, 5).find("another vessel"), std::string::npos);
  TreatmentBench other({"vessel.friction=0.2"});
  EXPECT_NE(refusalOf(other, state).find("another scene"), std::string::npos);
  TreatmentBench imaged({"fluoroscopy={primary_angle: 0.5}"});
  EXPECT_EQ(refusalOf(imaged, state), "") << "imaging has no influence on the motion";
  EXPECT_EQ(refusalOf(fresh, state), "");
  EXPECT_EQ(fresh.simulation.steps(), 20U);
}

constexpr std::size_t kFormatAt = 8;
constexpr std::size_t kWriterAt = 12;

std::uint32_t formatOf(const std::string& state)
{
  std::uint32_t format = 0;
  std::memcpy(&format, &state[kFormatAt], sizeof format);
  return format;
}

/** The state with another format and the hash of its new bytes. */
std::string withFormat(std::string state, std::uint32_t format)
{
  std::memcpy(&state[kFormatAt], &format, sizeof format);
  Hash64 hash;
  hash.add(state.data(), state.size() - sizeof(std::uint64_t));
  const std::uint64_t value = hash.value();
  std::memcpy(&state[state.size() - sizeof value], &value, sizeof value);
  return state;
}

/** The state without the writer and the physics number, which formats before 5 do not hold. */
std::string withoutWriter(std::string state)
{
  std::uint64_t letters = 0;
  std::memcpy(&letters, &state[kWriterAt], sizeof letters);
  return state.erase(kWriterAt, sizeof letters + letters + sizeof(int));
}

TEST(SavedStates, OfOtherFormatsAreRefusedWithTheVersionThatWroteThem)
{
  TreatmentBench bench;
  const std::string state = save(bench);
  const std::string old = refusalOf(bench, withFormat(withoutWriter(state), 4));
  EXPECT_NE(old.find("has format 4, written by endovascular_sim 0.1.0, commit ca765d6 or a later one"),
            std::string::npos)
      << old;
  const std::string later = refusalOf(bench, withFormat(state, formatOf(state) + 1));
  EXPECT_NE(later.find(std::string("written by endovascular_sim ") + version() + ", commit " + commit()),
            std::string::npos)
      << later;
}

// A seed that is refused would leave the archive behind its header without fuzzing.
TEST(SavedStates, OfTheFuzzCorpusLoad)
{
  std::ifstream file(PROJECT_DIR "/test/fuzz/corpus/state/straight_wire", std::ios::binary);
  ASSERT_TRUE(file.ignore(1));  // selects the hash
  fuzz::SmallSimulation small;
  EXPECT_NO_THROW(small.simulation.load(file)) << "write the corpus again with make_corpus";
  EXPECT_EQ(small.simulation.steps(), 1U);
}

TEST(SavedStates, OfAnotherPhysicsAreRefusedWithTheVersionThatWroteThem)
{
  TreatmentBench bench;
  std::string state = save(bench);
  std::uint64_t letters = 0;
  std::memcpy(&letters, &state[kWriterAt], sizeof letters);
  const int physics = kPhysicsNumber + 1;
  std::memcpy(&state[kWriterAt + sizeof letters + letters], &physics, sizeof physics);
  const std::string refusal = refusalOf(bench, withFormat(state, formatOf(state)));
  const std::string writer = "physics number " + std::to_string(physics) + " by endovascular_sim " + version();
  EXPECT_NE(refusal.find(writer), std::string::npos) << refusal;
}

}  // namespace
}  // namespace endovascular_sim::simulation
