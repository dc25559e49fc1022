#include "nodes/vessel_server/wall_deformation_server.h"

#include <gtest/gtest.h>

#include "common/archive.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "test/intervention/treated_tube.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Load of a balloon along the axis of the tube, inflated a little further with every version. */
BalloonLoad loadOf(std::uint64_t version)
{
  intervention::BalloonLoad load;
  for (int k = 0; k <= 32; ++k)
  {
    load.balloon.axis.emplace_back(0.0, 0.0, 0.022 + 0.016 * k / 32);
    load.balloon.radii.push_back(1e-3 + 0.02e-3 * static_cast<double>(version));
  }
  load.pressure = 8.0 * intervention::kAtmosphere;
  BalloonLoad message;
  toMessage(load, message);
  message.version = version;
  message.step = 8 * version;
  return message;
}

TEST(WallDeformationServer, SnapshotLagsAndItsDisplacementsLeadToTheNewestWall)
{
  const vessel::Vessel vessel = intervention::tubeWithLesion(0.7);
  WallDeformationServer server(vessel);
  geometry::TriangleMesh newest = vessel.mesh;
  for (std::uint64_t version = 2; version < 8; ++version)
  {
    WallDisplacement displacement;
    ASSERT_TRUE(server.press(loadOf(version), displacement));
    EXPECT_EQ(displacement.version, version);
    EXPECT_EQ(displacement.step, 8 * version);
    EXPECT_FALSE(displacement.index.empty());
    for (std::size_t k = 0; k < displacement.index.size(); ++k)
      newest.vertices[displacement.index[k]] = fromMessage(displacement.position[k]);

    WallDeformationServer::Snapshot snapshot = server.snapshot();
    EXPECT_EQ(snapshot.version + snapshot.displacements.size(), version);
    EXPECT_LE(snapshot.displacements.size(), simulation::kWallLag);
    for (const WallDisplacement& later : snapshot.displacements)
      for (std::size_t k = 0; k < later.index.size(); ++k)
        snapshot.mesh.vertices[later.index[k]] = fromMessage(later.position[k]);
    EXPECT_EQ(snapshot.mesh.hash(), newest.hash());
  }
}

TEST(WallDeformationServer, RejectsALoadForAnotherVersion)
{
  WallDeformationServer server(intervention::tubeWithLesion(0.7));
  WallDisplacement displacement;
  EXPECT_FALSE(server.press(loadOf(1), displacement));
  EXPECT_FALSE(server.press(loadOf(3), displacement));
  EXPECT_TRUE(server.press(loadOf(2), displacement));
  EXPECT_FALSE(server.press(loadOf(2), displacement));
  EXPECT_EQ(server.version(), 2U);
}

TEST(WallDeformationServer, ContinuesFromAStateWithTheSameDisplacements)
{
  WallDeformationServer server(intervention::tubeWithLesion(0.7));
  WallDisplacement displacement;
  for (std::uint64_t version = 2; version < 6; ++version)
    ASSERT_TRUE(server.press(loadOf(version), displacement));
  const std::string state = server.save(4);
  ASSERT_TRUE(server.press(loadOf(6), displacement));
  const WallDisplacement expected = displacement;
  const std::uint64_t expected_wall = server.snapshot().mesh.hash();

  WallDeformationServer other(intervention::tubeWithLesion(0.7));
  for (WallDeformationServer* resumed : {&server, &other})
  {
    resumed->load(state);
    EXPECT_EQ(resumed->version(), 5U);
    EXPECT_EQ(resumed->base(), 4U);
    EXPECT_EQ(resumed->save(4), state);
    ASSERT_TRUE(resumed->press(loadOf(6), displacement));
    EXPECT_EQ(displacement.index, expected.index);
    EXPECT_EQ(displacement.position, expected.position);
    EXPECT_EQ(resumed->snapshot().mesh.hash(), expected_wall);
  }
}

TEST(WallDeformationServer, ReturnsToTheInitialWall)
{
  const vessel::Vessel vessel = intervention::tubeWithLesion(0.7);
  WallDeformationServer server(vessel);
  const std::string initial = server.save(1);
  WallDisplacement displacement;
  for (std::uint64_t version = 2; version < 6; ++version)
    ASSERT_TRUE(server.press(loadOf(version), displacement));
  server.reset();
  EXPECT_EQ(server.version(), 1U);
  EXPECT_EQ(server.save(1), initial);
  EXPECT_EQ(server.snapshot().mesh.hash(), vessel.mesh.hash());
  EXPECT_TRUE(server.press(loadOf(2), displacement));
}

TEST(WallDeformationServer, KeepsItsWallWhenAStateIsRefused)
{
  WallDeformationServer server(intervention::tubeWithLesion(0.7));
  WallDisplacement displacement;
  ASSERT_TRUE(server.press(loadOf(2), displacement));
  ASSERT_TRUE(server.press(loadOf(3), displacement));
  const std::string state = server.save(2);
  for (const std::size_t size : {std::size_t{0}, state.size() / 2, state.size() - 1})
    EXPECT_THROW(server.load(state.substr(0, size)), ArchiveError) << size;
  EXPECT_THROW(server.load(state + "x"), ArchiveError);
  EXPECT_EQ(server.save(2), state);
  EXPECT_THROW(server.save(9), std::invalid_argument);
  EXPECT_TRUE(server.press(loadOf(4), displacement));
}

}  // namespace
}  // namespace endovascular_sim::nodes
