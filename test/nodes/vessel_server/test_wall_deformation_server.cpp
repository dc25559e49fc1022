#include "nodes/vessel_server/wall_deformation_server.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace endovascular_sim::nodes
