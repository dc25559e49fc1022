#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include <Eigen/Core>

#include "contact/detector.h"
#include "contact_fixtures.h"
#include "vessel/subdivision.h"

namespace endovascular_sim::contact
{
namespace
{

vessel::TriangleMesh fineTube()
{
  return vessel::flatSubdivision(bentTube(), 2);
}

/** A wire along the tube's wall. */
Query wireAlongTheWall(int nodes)
{
  Query wire;
  wire.margin = 0.4e-3;
  for (int k = 0; k < nodes; ++k)
  {
    wire.nodes.emplace_back(3.4e-3, 1e-4 * (k % 3), 0.5e-3 * k);
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
}

void removeNode(Query& wire, std::size_t index)
{
  const auto at = static_cast<std::ptrdiff_t>(index);
  wire.nodes.erase(wire.nodes.begin() + at);
  wire.radius.erase(wire.radius.begin() + at);
}

TEST(WireWhoseNodesComeAndGo, KeepsWhatIsListedAboutTheOthers)
{
  const vessel::TriangleMesh mesh = fineTube();
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
  vessel::TriangleMesh mesh = fineTube();
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

}  // namespace
}  // namespace endovascular_sim::contact
