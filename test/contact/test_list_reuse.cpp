#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "contact/broad_phase/wire_lists.h"
#include "contact/detector.h"
#include "geometry/loop_subdivision.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

geometry::TriangleMesh fineTube()
{
  return geometry::midpointSubdivision(bentTube(), 2);
}

/** A wire along the tube's wall. @param slid displacement along the tube; zero gives a zigzag [m] */
Query wireAlongTheWall(int nodes, double spacing = 0.5e-3, double slid = 0.0)
{
  Query wire;
  wire.margin.assign(static_cast<std::size_t>(nodes), 0.4e-3);
  for (int k = 0; k < nodes; ++k)
  {
    wire.nodes.emplace_back(3.4e-3, slid == 0.0 ? 1e-4 * (k % 3) : 0.0, spacing * k + slid);
    wire.radius.push_back(0.4e-3);
  }
  return wire;
}

void insertNode(Query& wire, std::size_t before)
{
  const auto at = static_cast<std::ptrdiff_t>(before);
  const Eigen::Vector3d middle = 0.5 * (wire.nodes[before - 1] + wire.nodes[before]);
  wire.nodes.insert(wire.nodes.begin() + at, middle);
  wire.radius.insert(wire.radius.begin() + at, wire.radius[before]);
  wire.margin.insert(wire.margin.begin() + at, wire.margin[before]);
}

void removeNode(Query& wire, std::size_t index)
{
  const auto at = static_cast<std::ptrdiff_t>(index);
  wire.nodes.erase(wire.nodes.begin() + at);
  wire.radius.erase(wire.radius.begin() + at);
  wire.margin.erase(wire.margin.begin() + at);
}

TEST(ListReuse, GivesTheBitsOfANewDetectorWhenNodesAreInsertedAndRemoved)
{
  geometry::TriangleMesh mesh = fineTube();
  Detector warm(mesh, WallLaw{});
  std::mt19937 random(21);
  std::normal_distribution<double> normal(0.0, 1.0);
  Query wire = wireAlongTheWall(60);
  std::uint64_t version = 1;
  std::size_t features = 0;
  for (std::uint64_t step = 2; step < 150; ++step)
  {
    for (Eigen::Vector3d& node : wire.nodes)
      node += 2e-5 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    const auto any_node = [&] { return 1 + random() % (wire.nodes.size() - 1); };
    for (std::uint64_t k = random() % 3; k > 0; --k)
      insertNode(wire, any_node());
    while (wire.nodes.size() > 58 + random() % 8)
      removeNode(wire, any_node());
    if (step % 10 == 0)
    {
      const Movement movement = pushOut(mesh, wire.nodes[any_node()], 4e-3, 0.02);
      apply(movement, mesh);
      version = step;
      warm.moveVertices(movement.indices, movement.positions, version);
    }
    ContactSet reused, fresh;
    warm.detect(wire, reused);
    Detector fresh_detector(mesh, WallLaw{}, version);
    fresh_detector.detect(wire, fresh);
    expectSameSets(reused, fresh);
    features += reused.features.size();
  }
  EXPECT_GT(features, 1000U);
}

TEST(ListReuse, GivesTheBitsOfANewDetectorToASlidingWire)
{
  geometry::TriangleMesh mesh = fineTube();
  Detector warm(mesh, WallLaw{});
  std::mt19937 random(22);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::uint64_t version = 1;
  std::size_t features = 0;
  double slid = 1e-3;  // m
  double aside = 0.0;  // m
  int nodes = 18;
  for (int step = 2; step < 400; ++step)
  {
    // Slides back and forth, with occasional jumps to another side or another number of nodes.
    slid = 6e-3 + 5e-3 * std::sin(0.05 * step) + 2e-5 * share(random);
    aside += step % 50 == 0 ? 2e-4 * share(random) : 4e-6 * share(random);
    if (step % 60 == 0)
      nodes = 18 + static_cast<int>(random() % 4);
    Query wire = wireAlongTheWall(nodes, 1.2e-3, slid);
    wire.margin.assign(wire.nodes.size(), step % 70 < 60 ? 0.4e-3 : 0.5e-3);
    for (Eigen::Vector3d& node : wire.nodes)
      node += Eigen::Vector3d(0.5 * aside, aside, 0.0);
    if (step % 90 == 0)
    {
      const Movement movement = pushOut(mesh, wire.nodes[random() % wire.nodes.size()], 4e-3, 0.02);
      apply(movement, mesh);
      version = static_cast<std::uint64_t>(step);
      warm.moveVertices(movement.indices, movement.positions, version);
    }
    ContactSet reused, fresh;
    warm.detect(wire, reused);
    Detector fresh_detector(mesh, WallLaw{}, version);
    fresh_detector.detect(wire, fresh);
    expectSameSets(reused, fresh);
    features += reused.features.size();
  }
  EXPECT_GT(features, 1000U);
}

// All lists of a wire that begins to slide expire in its first queries, and would expire together from then on.
TEST(ListReuse, OfAWireThatBeginsToSlideIsSpreadOverTheQueries)
{
  const auto model = WallModel::create(fineTube());
  WireLists lists;
  const int nodes = 100;
  std::size_t sum = 0;
  std::size_t most = 0;
  const int queries = 200;
  for (int k = 0; k < queries; ++k)
  {
    const Query wire = wireAlongTheWall(nodes, 0.25e-3, 1e-9 + 35e-6 * k);
    const std::size_t built = lists.update(model->bvh(), model->bounds(), wire, 0.0);
    if (k < 5)
      continue;
    sum += built;
    most = std::max(most, built);
  }
  EXPECT_GT(sum, 5U * nodes);
  EXPECT_LE(most, 40U);
}

}  // namespace
}  // namespace endovascular_sim::contact
