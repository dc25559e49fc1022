#include "nodes/player/recorded_wall.h"

#include <random>

#include <gtest/gtest.h>

#include "test/nodes/player/played_session.h"

namespace endovascular_sim::nodes
{
namespace
{

std::string bytesOf(const VesselMesh& mesh)
{
  std::string bytes(ros::serialization::serializationLength(mesh), '\0');
  ros::serialization::OStream out(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                  static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, mesh);
  return bytes;
}

class Wall : public testing::Test
{
protected:
  /** Vertices after all displacements up to a state, each applied in its order. */
  std::vector<geometry_msgs::Point> expected(std::uint64_t state) const
  {
    std::vector<geometry_msgs::Point> vertices = session.mesh().mesh.vertices;
    for (std::uint64_t k = 20; k <= state; ++k)
    {
      geometry_msgs::Point first, second;
      first.x = 1e-3 * static_cast<double>(k);
      second.z = 1e-4 * static_cast<double>(k);
      vertices[k % vertices.size()] = first;
      vertices[2] = second;
    }
    return vertices;
  }

  TemporaryFolder folder;
  const PlayedSession session{folder.file("session.bag")};
  const BagTimeline timeline{{session.file()}};
};

TEST_F(Wall, IsTheRecordedMeshUntilABalloonMovesIt)
{
  RecordedWall wall(timeline);
  EXPECT_FALSE(wall.at(ros::Time(PlayedSession::kBegin - 1.0)));
  ASSERT_TRUE(wall.at(timeline.states()[19].end));
  EXPECT_EQ(bytesOf(*wall.at(timeline.states()[19].end)), bytesOf(session.mesh()));
  EXPECT_EQ(wall.versionAt(timeline.states()[19].end), 1U);
}

TEST_F(Wall, HasAtAnyTimeAllDisplacementsUpToThen)
{
  RecordedWall wall(timeline);
  std::mt19937 random(7);
  for (int k = 0; k < 60; ++k)
  {
    const std::size_t state = random() % timeline.states().size();
    const VesselMesh shown = *wall.at(timeline.states()[state].end);
    EXPECT_EQ(shown.mesh.vertices, expected(state)) << state;
    EXPECT_EQ(shown.version, state < 20 ? 1U : state - 18);
    EXPECT_EQ(*wall.versionAt(timeline.states()[state].end), shown.version);
    EXPECT_NO_THROW(fromMessage(shown)) << "the content hash is that of the vertices";
  }
}

}  // namespace
}  // namespace endovascular_sim::nodes
