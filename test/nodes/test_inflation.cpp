#include <map>
#include <memory>

#include <crtk_msgs/OperatingState.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/replay_source.h"
#include "simulation/simulation.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{
namespace
{

/** Listener to the steps and the wall of the graph. */
class Listener
{
public:
  explicit Listener(const std::string& instrument)
  {
    observer_.subscribe<DriveApplied>(nodes::names::kDriveApplied,
                                      [this](const DriveApplied& message) { steps_[message.step] = message; });
    observer_.subscribe<WallDisplacement>(nodes::names::kWallDisplacement, [this](const WallDisplacement& message)
                                          { moved_vertices_ += message.index.size(); });
    observer_.subscribe<VesselMesh>(nodes::names::kVesselMesh,
                                    [this](const VesselMesh& message) { newest_mesh_ = message; });
    observer_.subscribe<crtk_msgs::OperatingState>(
        nodes::names::kInstruments + instrument + nodes::names::kOperatingState,
        [this](const crtk_msgs::OperatingState& message) { operating_ = message.state; });
  }

  std::map<std::uint64_t, DriveApplied> steps() const { return observer_.copy(steps_); }
  std::size_t movedVertices() const { return observer_.copy(moved_vertices_); }
  VesselMesh newestMesh() const { return observer_.copy(newest_mesh_); }
  std::string operatingState() const { return observer_.copy(operating_); }

private:
  std::map<std::uint64_t, DriveApplied> steps_;
  std::size_t moved_vertices_ = 0;
  VesselMesh newest_mesh_;
  std::string operating_;
  TopicObserver observer_;  ///< last, so that it ends before the data that it takes over
};

class Inflation : public testing::Test
{
protected:
  void SetUp() override
  {
    scene_ = nodes::sceneFromParameters(ros::NodeHandle());
    listener_ = std::make_unique<Listener>(scene_.instruments.front().instrument.name);
    ASSERT_TRUE(waitUntil(60.0, [this] { return listener_->steps().size() > 100; })) << "the graph does not step";
  }

  scene::Scene scene_;
  std::unique_ptr<Listener> listener_;
};

TEST_F(Inflation, A_GraphEqualsTheOfflineSimulationWhileABalloonMovesTheWall)
{
  ASSERT_TRUE(waitUntil(120.0, [this] { return listener_->steps().rbegin()->first > 2500; }));
  EXPECT_GT(listener_->movedVertices(), 500U);
  const std::map<std::uint64_t, DriveApplied> steps = listener_->steps();
  const vessel::Vessel vessel =
      scene::buildVessel(*scene_.vessel, scene_.entry, scene_.file, scene::CentrelineUse::kRequired);
  contact::Detector detector(vessel.mesh, scene::wallLaw(*scene_.vessel));
  simulation::LocalDeformableWall wall(vessel, detector);
  simulation::ReplayContactSource source(detector);
  simulation::Simulation simulation(scene_, scene::resolveEntry(scene_.entry, vessel, scene_.file), &source,
                                    &vessel.centreline, &wall);
  // The listener may join late: earlier steps are simulated from the script of the scene, which also drives the graph.
  std::uint64_t compared = 0;
  while (simulation.steps() <= steps.rbegin()->first)
  {
    const auto known = steps.find(simulation.steps());
    const double end = static_cast<double>(simulation.steps() + 1) * scene_.solver.time_step;
    const std::vector<drive::HandCommand> commands = simulation::commandsAt(scene_, end);
    source.setFirstStalePass(known != steps.end() ? known->second.first_stale_pass : contact::kNoStalePass);
    if (known != steps.end())
    {
      EXPECT_EQ(known->second.pressure.at(0), commands[0].pressure);
    }
    simulation.stepAll(commands);
    if (known == steps.end())
      continue;
    ASSERT_EQ(known->second.state_hash, simulation.stateHash()) << "step " << known->first;
    ++compared;
  }
  EXPECT_GT(compared, 2000U);
  EXPECT_GT(wall.version(), 100U);
  // The mesh for display follows the wall.
  ASSERT_TRUE(waitUntil(10.0, [this] { return listener_->newestMesh().version > 100; }));
  EXPECT_NE(listener_->newestMesh().content_hash, vessel.mesh.hash());
  EXPECT_EQ(listener_->newestMesh().content_hash, nodes::fromMessage(listener_->newestMesh()).hash());
}

TEST_F(Inflation, B_LossOfTheVesselServerEndsTheSimulation)
{
  ASSERT_TRUE(waitUntil(20.0, [this] { return listener_->operatingState() == "ENABLED"; }));
  ASSERT_TRUE(killNode("/vessel_server"));
  EXPECT_TRUE(waitUntil(10.0, [this] { return listener_->operatingState() == "DISABLED"; }));
}

}  // namespace
}  // namespace endovascular_sim
