#include <functional>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "geometry/loop_subdivision.h"
#include "test/contact/contact_fixtures.h"

// Detectors in several threads. The thread sanitizer checks the accesses, the expectations check the results.

namespace endovascular_sim::contact
{
namespace
{

constexpr int kThreads = 4;

/** Wires of one thread. */
std::vector<Query> wiresOf(int thread)
{
  std::mt19937 random(static_cast<unsigned>(31 + thread));
  std::vector<Query> wires;
  for (int k = 0; k < 12; ++k)
    wires.push_back(randomWire({0.0, 0.0, 0.0025 * k}, random, 25));
  Query along_wall = randomWire({0.0, 0.0, 0.01}, random, 200);
  for (std::size_t i = 0; i < along_wall.nodes.size(); ++i)
    along_wall.nodes[i] = {3.4e-3, 1e-5 * thread, 0.1e-3 * static_cast<double>(i)};
  wires.push_back(along_wall);
  return wires;
}

std::vector<ContactSet> detectAll(Detector& detector, const std::vector<Query>& wires)
{
  std::vector<ContactSet> sets(wires.size());
  for (std::size_t k = 0; k < wires.size(); ++k)
    detector.detect(wires[k], sets[k]);
  return sets;
}

std::size_t expectSetsOfASingleThread(const geometry::TriangleMesh& mesh, int thread,
                                      const std::vector<ContactSet>& sets)
{
  Detector reference(mesh, WallLaw{});
  const std::vector<ContactSet> expected = detectAll(reference, wiresOf(thread));
  EXPECT_EQ(sets.size(), expected.size());
  std::size_t features = 0;
  for (std::size_t k = 0; k < sets.size(); ++k)
  {
    expectSameSets(sets[k], expected[k]);
    features += sets[k].features.size();
  }
  return features;
}

void inThreads(const std::function<void(int)>& work)
{
  std::vector<std::thread> threads;
  for (int k = 0; k < kThreads; ++k)
    threads.emplace_back(work, k);
  for (std::thread& thread : threads)
    thread.join();
}

/** Mesh, its wall shared by the detectors of all threads, and their contact sets. */
class WallModelInThreads : public testing::Test
{
protected:
  const geometry::TriangleMesh mesh = geometry::midpointSubdivision(bentTube(), 2);
  const std::shared_ptr<const WallModel> model = WallModel::create(mesh);
  std::vector<std::vector<ContactSet>> sets = std::vector<std::vector<ContactSet>>(kThreads);
};

TEST_F(WallModelInThreads, GivesEveryDetectorTheBitsOfASingleThread)
{
  inThreads(
      [&](int k)
      {
        Detector detector(model, WallLaw{});
        sets[static_cast<std::size_t>(k)] = detectAll(detector, wiresOf(k));
      });
  std::size_t features = 0;
  for (int k = 0; k < kThreads; ++k)
    features += expectSetsOfASingleThread(mesh, k, sets[static_cast<std::size_t>(k)]);
  EXPECT_GT(features, 100U);
}

TEST_F(WallModelInThreads, KeepsTheWallOfOtherThreadsWhileOneMovesIts)
{
  inThreads(
      [&](int k)
      {
        Detector detector(model, WallLaw{});
        if (k == 0)
        {
          geometry::TriangleMesh moved = mesh;
          for (std::uint64_t version = 2; version < 6; ++version)
          {
            const Movement movement = pushOut(moved, {0.0, 0.0, 0.005 * static_cast<double>(version)}, 6e-3, 0.2);
            apply(movement, moved);
            detector.moveVertices(movement.indices, movement.positions, version);
          }
          EXPECT_NE(detector.model(), model);
        }
        sets[static_cast<std::size_t>(k)] = detectAll(detector, wiresOf(k));
      });
  for (int k = 1; k < kThreads; ++k)
    EXPECT_GT(expectSetsOfASingleThread(mesh, k, sets[static_cast<std::size_t>(k)]), 0U);
}

TEST_F(WallModelInThreads, IsMovedInPlaceAfterAnotherThreadHasReleasedIt)
{
  Detector detector(WallModel::create(mesh), WallLaw{});
  const WallModel* before = detector.model().get();
  std::thread other(
      [model = detector.model()]() mutable
      {
        Detector reader(std::move(model), WallLaw{});
        detectAll(reader, wiresOf(1));
      });
  // The count of owners is the only order between the threads: join() follows the movement.
  while (detector.model().use_count() != 1)
    std::this_thread::yield();
  const Movement movement = pushOut(mesh, {0.0, 0.0, 0.01}, 6e-3, 0.2);
  detector.moveVertices(movement.indices, movement.positions, 2);
  EXPECT_EQ(detector.model().get(), before);
  other.join();
}

}  // namespace
}  // namespace endovascular_sim::contact
