#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

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

/** A wire along the tube's wall. @param slid from where it begins [m] */
Query wireAlongTheWall(int nodes, double spacing = 0.5e-3, double slid = 0.0)
{
  Query wire;
  wire.margin = 0.4e-3;
  for (int k = 0; k < nodes; ++k)
  {
    wire.nodes.emplace_back(3.4e-3, slid == 0.0 ? 1e-4 * (k % 3) : 0.0, spacing * k + slid);
    wire.radius.push_back(0.4e-3);
  }
  return wire;
}

/** Nodes of a detector that had to be listed anew for a wire that slides. */
std::uint64_t renewedBySliding(Detector& detector, std::uint64_t nodes, double from, double to)
{
  constexpr int kSteps = 50;
  constexpr double kSpacing = 1.2e-3;  // m
  const std::uint64_t before = detector.listsRenewed();
  ContactSet set;
  for (int step = 1; step <= kSteps; ++step)
    detector.detect(wireAlongTheWall(static_cast<int>(nodes), kSpacing, from + (to - from) * step / kSteps), set);
  return detector.listsRenewed() - before;
}

void insertNode(Query& wire, std::size_t before)
{
  const auto at = static_cast<std::ptrdiff_t>(before);
  const Eigen::Vector3d middle = 0.5 * (wire.nodes[before - 1] + wire.nodes[before]);
  wire.nodes.insert(wire.nodes.begin() + at, middle);
  wire.radius.insert(wire.radius.begin() + at, wire.radius[before]);
}

void removeNode(Query& wire, std::size_t index)
{
  const auto at = static_cast<std::ptrdiff_t>(index);
  wire.nodes.erase(wire.nodes.begin() + at);
  wire.radius.erase(wire.radius.begin() + at);
}

TEST(WireWhoseNodesComeAndGo, KeepsWhatIsListedAboutTheOthers)
{
  const geometry::TriangleMesh mesh = fineTube();
  Detector detector(mesh, WallLaw{});
  Query wire = wireAlongTheWall(60);
  ContactSet set;
  detector.detect(wire, set);
  const auto renewedBy = [&](const Query& query)
  {
    const std::uint64_t before = detector.listsRenewed();
    detector.detect(query, set);
    return detector.listsRenewed() - before;
  };
  EXPECT_EQ(renewedBy(wire), 0U);
  insertNode(wire, 50);
  EXPECT_LE(renewedBy(wire), 2U);
  removeNode(wire, 40);
  removeNode(wire, 30);
  EXPECT_LE(renewedBy(wire), 4U);
  removeNode(wire, wire.nodes.size() - 1);  // the tip
  EXPECT_LE(renewedBy(wire), 2U);
}

TEST(WireWhoseNodesComeAndGo, GetsTheAnswersOfADetectorThatIsMadeAnew)
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
    const auto place = [&] { return 1 + random() % (wire.nodes.size() - 1); };
    for (std::uint64_t k = random() % 3; k > 0; --k)
      insertNode(wire, place());
    while (wire.nodes.size() > 58 + random() % 8)
      removeNode(wire, place());
    if (step % 10 == 0)
    {
      const Movement movement = pushOut(mesh, wire.nodes[place()], 4e-3, 0.02);
      apply(movement, mesh);
      version = step;
      warm.moveVertices(movement.indices, movement.positions, version);
    }
    ContactSet followed, fresh;
    warm.detect(wire, followed);
    Detector anew(mesh, WallLaw{}, version);
    anew.detect(wire, fresh);
    expectSameSets(followed, fresh);
    features += followed.features.size();
  }
  EXPECT_GT(features, 1000U);
}

TEST(WireThatSlides, TakesOverWhatWasListedForTheNodesBeforeIt)
{
  const geometry::TriangleMesh mesh = geometry::midpointSubdivision(fineTube(), 1);
  constexpr std::uint64_t kNodes = 20;
  const auto renewed = [&mesh](const std::vector<double>& places)
  {
    Detector detector(mesh, WallLaw{});
    for (std::size_t k = 1; k + 1 < places.size(); ++k)
      renewedBySliding(detector, kNodes, places[k - 1], places[k]);
    return renewedBySliding(detector, kNodes, places[places.size() - 2], places.back());
  };
  // The first way is listed by all, then what is new at the tip only, and what is behind the other end.
  EXPECT_GT(renewed({0.5e-3, 1.7e-3}), 2 * kNodes);
  EXPECT_LT(renewed({0.5e-3, 2.1e-3, 4.5e-3}), kNodes);
  EXPECT_LT(renewed({0.5e-3, 2.1e-3, 4.5e-3, 2.9e-3}), 15U);
  EXPECT_LT(renewed({0.5e-3, 2.1e-3, 4.5e-3, 2.9e-3, 2.1e-3}), 8U);
  EXPECT_LT(renewed({0.5e-3, 2.1e-3, 4.5e-3, 2.9e-3, 4.5e-3}), 15U);
}

TEST(WireThatSlides, GetsTheAnswersOfADetectorThatIsMadeAnew)
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
    // To and fro, past the places that were left, and now and then all at once to another side or another length.
    slid = 6e-3 + 5e-3 * std::sin(0.05 * step) + 2e-5 * share(random);
    aside += step % 50 == 0 ? 2e-4 * share(random) : 4e-6 * share(random);
    if (step % 60 == 0)
      nodes = 18 + static_cast<int>(random() % 4);
    Query wire = wireAlongTheWall(nodes, 1.2e-3, slid);
    wire.margin = step % 70 < 60 ? 0.4e-3 : 0.5e-3;
    for (Eigen::Vector3d& node : wire.nodes)
      node += Eigen::Vector3d(0.5 * aside, aside, 0.0);
    if (step % 90 == 0)
    {
      const Movement movement = pushOut(mesh, wire.nodes[random() % wire.nodes.size()], 4e-3, 0.02);
      apply(movement, mesh);
      version = static_cast<std::uint64_t>(step);
      warm.moveVertices(movement.indices, movement.positions, version);
    }
    ContactSet followed, fresh;
    warm.detect(wire, followed);
    Detector anew(mesh, WallLaw{}, version);
    anew.detect(wire, fresh);
    expectSameSets(followed, fresh);
    features += followed.features.size();
  }
  EXPECT_GT(features, 1000U);
}

}  // namespace
}  // namespace endovascular_sim::contact
