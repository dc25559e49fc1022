#include "common/helper_thread.h"

#include <chrono>
#include <future>
#include <vector>

#include <gtest/gtest.h>

#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

using namespace std::chrono_literals;

TEST(HelperThread, RunsEveryTaskOnce)
{
  HelperThread helper([] {});
  std::vector<int> done(300);
  std::uint64_t all = 0;
  for (int round = 0; round < 2000; ++round)
  {
    const auto count = static_cast<std::uint32_t>(round % 300);
    helper.run(count, [&done](std::uint32_t index) { ++done[index]; });
    all += count;
    for (std::uint32_t index = 0; index < 300; ++index)
      all -= static_cast<std::uint64_t>(std::exchange(done[index], 0));
    ASSERT_EQ(all, 0U) << round;
  }
}

TEST(HelperThread, LeavesAllToTheCallerWhereItComesTooLate)
{
  std::promise<void> late;
  HelperThread helper([&late] { late.get_future().wait(); });
  std::vector<std::thread::id> by(20);
  helper.run(20, [&by](std::uint32_t index) { by[index] = std::this_thread::get_id(); });
  for (const std::thread::id& id : by)
    EXPECT_EQ(id, std::this_thread::get_id());
  EXPECT_EQ(helper.helped(), 0U);
  late.set_value();
}

TEST(HelperThread, TakesTheLastTasksAndIsWaitedFor)
{
  HelperThread helper([] {});
  std::promise<void> begun, taken;
  std::thread::id by;
  bool over = false;
  helper.run(2,
             [&](std::uint32_t index)
             {
               if (index == 0)
               {
                 taken.set_value();
                 return begun.get_future().wait();
               }
               begun.set_value();
               taken.get_future().wait();          // or else the first one would be the helper's, too
               std::this_thread::sleep_for(20ms);  // longer than the caller looks
               by = std::this_thread::get_id();
               over = true;
             });
  EXPECT_TRUE(over);
  EXPECT_NE(by, std::this_thread::get_id());
  EXPECT_EQ(helper.helped(), 1U);
}

/** A filled balloon along the channel's straight part, at some place. */
Query balloon(double place)
{
  Query query;
  query.margin = 0.25e-3;
  query.first_node = 5;
  for (int i = 0; i < 40; ++i)
  {
    query.nodes.emplace_back(1e-5 * i, 0.0, place + 0.5e-3 * i);
    query.radius.push_back(3.9e-3);
  }
  return query;
}

TEST(HelperThread, SharesALongSearchToTheSameBits)
{
  const geometry::TriangleMesh mesh = bumpy(geometry::midpointSubdivision(bentTube(), 3), 0.02);
  Detector alone(mesh, WallLaw{1e6, 0.1, {}});
  Detector shared(mesh, WallLaw{1e6, 0.1, {}});
  HelperThread helper([] {});
  shared.setHelper(&helper);
  ContactSet one, two;
  std::size_t features = 0;
  for (int k = 0; k < 50 || (helper.helped() == 0 && k < 5000); ++k)
  {
    const Query query = balloon(2e-3 + 1e-4 * (k % 40));
    alone.detect(query, one);
    shared.detect(query, two);
    expectSameSets(one, two);
    features += two.features.size();
  }
  EXPECT_GT(features, 1000U);
  EXPECT_GT(helper.helped(), 0U) << "the search was long enough to be shared";
}

TEST(HelperThread, SharesAMovementOfTheWallToTheSameBits)
{
  geometry::TriangleMesh mesh = bumpy(geometry::midpointSubdivision(bentTube(), 3), 0.02);
  HelperThread helper([] {});
  Detector shared(mesh, WallLaw{});
  shared.setHelper(&helper);
  ContactSet one, two;
  std::uint64_t moved_by_helper = 0;
  for (std::uint64_t version = 2; version < 20 || (moved_by_helper == 0 && version < 500); ++version)
  {
    const Movement movement = pushOut(mesh, {0.0, 0.0, 1e-3 * static_cast<double>(version % 20)}, 6e-3, 0.02);
    ASSERT_GT(movement.indices.size(), 100U);
    shared.detect(balloon(5e-3), two);
    apply(movement, mesh);
    const std::uint64_t before = helper.helped();
    shared.moveVertices(movement.indices, movement.positions, version);
    moved_by_helper += helper.helped() - before;
    Detector anew(mesh, WallLaw{}, version);
    expectSameWalls(shared.wall(), anew.wall());
    anew.detect(balloon(5e-3), one);
    shared.detect(balloon(5e-3), two);
    expectSameSets(one, two);
  }
  EXPECT_GT(moved_by_helper, 0U);
}

}  // namespace
}  // namespace endovascular_sim::contact
