#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/hash.h"
#include "scene/scene_file.h"
#include "simulation/simulation.h"
#include "test/common/random_damage.h"
#include "test/simulation/treatment_bench.h"

// Damaged saved states: a state that loads has all the values from which a step continues, or load() throws InputError.

namespace endovascular_sim::simulation
{
namespace
{

constexpr int kCopies = 1000;            // damaged copies of one state
constexpr int kCopiesWithWall = 300;     // the same of a scene with vessel and balloon, whose simulation is slower
constexpr std::size_t kMostChanges = 2;  // of a copy with a renewed hash: more changes rarely load
constexpr int kSteps = 5;                // steps before the state is saved

/** Wire of a few nodes without a vessel. */
struct WireBench
{
  WireBench()
    : scene(scene::loadScene(PROJECT_DIR "/config/scenes/straight_wire.yaml", {"sampling.nodes=33"})),
      simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr)
  {
  }

  scene::Scene scene;
  Simulation simulation;
};

template <typename Bench>
void step(Bench& bench)
{
  bench.simulation.stepAll(commandsAt(bench.scene, bench.simulation.time() + bench.scene.solver.time_step));
}

template <typename Bench>
std::string stateOf(Bench& bench)
{
  std::ostringstream stream;
  bench.simulation.save(stream);
  return stream.str();
}

/** Loads a state.
 *  @return false where it is refused; the error names the state */
template <typename Bench>
bool loads(Bench& bench, const std::string& state)
{
  try
  {
    std::istringstream stream(state);
    bench.simulation.load(stream, 0, "a.state");
  }
  catch (const InputError& error)
  {
    EXPECT_NE(std::string(error.what()).find("a.state"), std::string::npos) << error.what();
    return false;
  }
  return true;
}

/** The bytes with the hash of their content at the end, in place of the present one. */
std::string withRenewedHash(std::string bytes)
{
  bytes.resize(bytes.size() - std::min(bytes.size(), sizeof(std::uint64_t)));
  Hash64 hash;
  hash.add(bytes.data(), bytes.size());
  const std::uint64_t value = hash.value();
  return bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

bool areFinite(const std::vector<Eigen::Vector3d>& vectors)
{
  return std::all_of(vectors.begin(), vectors.end(), [](const Eigen::Vector3d& v) { return v.allFinite(); });
}

/** Loads damaged copies whose hash is renewed, so that only the checks of the values protect the simulation. Each is
 *  refused, or the positions are finite before and after a step, whether or not the step is solved. */
template <typename Bench>
void expectRefusedOrFinite(Bench& bench, int copies, std::uint32_t seed)
{
  for (int k = 0; k < kSteps; ++k)
    step(bench);
  const std::string state = stateOf(bench);
  test::RandomDamage damage(seed);
  int loaded = 0;
  for (int k = 0; k < copies; ++k)
  {
    SCOPED_TRACE("copy " + std::to_string(k));
    if (!loads(bench, withRenewedHash(damage.of(state, kMostChanges))))
      continue;
    ++loaded;
    ASSERT_TRUE(areFinite(bench.simulation.state().position));
    step(bench);
    ASSERT_TRUE(areFinite(bench.simulation.state().position)) << "solved: " << bench.simulation.report().solved;
  }
  EXPECT_GT(loaded, 0);
  EXPECT_LT(loaded, copies);
  ASSERT_TRUE(loads(bench, state));  // refused states leave nothing behind
  EXPECT_EQ(stateOf(bench), state);
}

TEST(DamagedState, IsRefusedUnlessItEqualsTheOriginal)
{
  WireBench bench;
  for (int k = 0; k < kSteps; ++k)
    step(bench);
  const std::string state = stateOf(bench);
  test::RandomDamage damage(1);
  int refused = 0;
  for (int k = 0; k < kCopies; ++k)
  {
    const std::string damaged = damage.of(state);
    if (loads(bench, damaged))
    {
      EXPECT_EQ(damaged, state) << "copy " << k;
    }
    else
      ++refused;
  }
  EXPECT_GT(refused, kCopies / 2);
}

TEST(DamagedState, WithARenewedHashIsRefusedOrContinuesWithFinitePositions)
{
  WireBench bench;
  expectRefusedOrFinite(bench, kCopies, 2);
}

TEST(DamagedState, OfABalloonInAVesselWithARenewedHashIsRefusedOrContinuesWithFinitePositions)
{
  TreatmentBench bench;
  expectRefusedOrFinite(bench, kCopiesWithWall, 3);
}

}  // namespace
}  // namespace endovascular_sim::simulation
