#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <visualization_msgs/Marker.h>

#include "contact/detector.h"
#include "endovascular_sim/DriveApplied.h"
#include "nodes/contact/contact_node.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/fluoroscopy/fluoroscopy_node.h"
#include "nodes/rod_dynamics/rod_dynamics_node.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"
#include "nodes/session/session_bag.h"
#include "nodes/session/session_node.h"
#include "nodes/vessel_server/vessel_server_node.h"
#include "nodes/visualization/motion_history.h"
#include "nodes/visualization/visualization_node.h"
#include "scene/scene_vessel.h"
#include "simulation/replay_source.h"
#include "simulation/simulation.h"
#include "test/nodes/graph_testing.h"

namespace endovascular_sim::nodes
{
namespace
{

/** All steps that a rod publishes. */
class StepListener
{
public:
  StepListener()
  {
    subscriber_ = node_.subscribe<DriveApplied>(names::kDriveApplied, 10000,
                                                [this](const DriveAppliedConstPtr& message)
                                                {
                                                  const std::lock_guard<std::mutex> lock(mutex_);
                                                  steps_[message->step] = *message;
                                                });
  }

  std::map<std::uint64_t, DriveApplied> steps() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return steps_;
  }

private:
  ros::NodeHandle node_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, DriveApplied> steps_;
  ros::Subscriber subscriber_;
};

/** Session node with a callback queue and a thread of its own, as in its process. */
class Recording
{
public:
  explicit Recording(const scene::Scene& scene) : spinner_(1, &queue_)
  {
    ros::NodeHandle parameters("~recording");
    parameters.setParam("results", folder_);
    ros::NodeHandle node;
    node.setCallbackQueue(&queue_);
    session_ = std::make_unique<SessionNode>(node, parameters, scene);
    spinner_.start();
  }
  ~Recording()
  {
    finish();
    std::filesystem::remove_all(folder_);
  }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /** Ends the recording. @return number of steps in its bag */
  std::size_t recordedSteps()
  {
    finish();
    return readSessionBag(folder_ + "/session.bag").steps.size();
  }

private:
  void finish()
  {
    spinner_.stop();
    queue_.callAvailable();
    session_.reset();
  }

  std::string folder_ = testing::TempDir() + "/recording_" + std::to_string(::getpid());
  ros::CallbackQueue queue_;
  std::unique_ptr<SessionNode> session_;
  ros::AsyncSpinner spinner_;
};

TEST(NodeClasses, StepInOneProcessWithTheBitsOfTheOfflineSimulation)
{
  ros::NodeHandle node;
  const scene::Scene scene = sceneFromParameters(node);
  const StepListener listener;
  const VesselServerNode server(node, scene);
  const ContactNode contact(node, scene);
  const VisualizationNode visualization(node, ros::NodeHandle("~"));
  const std::unique_ptr<Recording> recording = std::make_unique<Recording>(scene);
  RodDynamicsNode rod(node, ros::NodeHandle("~rod"), scene);
  ASSERT_TRUE(rod.run());
  waitUntil(2.0, [&listener] { return listener.steps().size() >= 300; });
  const std::map<std::uint64_t, DriveApplied> steps = listener.steps();
  ASSERT_EQ(steps.size(), 300U);
  EXPECT_EQ(recording->recordedSteps(), 300U);

  const vessel::Vessel vessel =
      scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired);
  contact::Detector detector(vessel.mesh, scene::wallLaw(*scene.vessel));
  simulation::ReplayContactSource source(detector);
  simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &source,
                                    &vessel.centreline);
  for (const auto& [step, applied] : steps)
  {
    source.setFirstStalePass(applied.first_stale_pass);
    simulation.stepAll(simulation::commandsAt(scene, static_cast<double>(step + 1) * scene.solver.time_step));
    ASSERT_EQ(applied.state_hash, simulation.stateHash()) << "step " << step;
  }
}

/** Newest marker of a topic. */
class MarkerListener
{
public:
  explicit MarkerListener(const char* topic)
  {
    subscriber_ = node_.subscribe<visualization_msgs::Marker>(topic, 1,
                                                              [this](const visualization_msgs::MarkerConstPtr& message)
                                                              {
                                                                const std::lock_guard<std::mutex> lock(mutex_);
                                                                newest_ = message;
                                                              });
  }

  visualization_msgs::MarkerConstPtr newest() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return newest_;
  }

private:
  ros::NodeHandle node_;
  mutable std::mutex mutex_;
  visualization_msgs::MarkerConstPtr newest_;
  ros::Subscriber subscriber_;
};

/** Motion of the whole tube. */
MotionState motionOfTube(double time, double shift)
{
  MotionState motion;
  motion.step = static_cast<std::uint64_t>(1e3 * time);
  motion.time = time;
  motion.axis.z = 1.0;
  motion.fade_core = 1.0;
  motion.fade_reach = 2.0;
  motion.shift.x = shift;
  motion.twist = 1.0;
  return motion;
}

TEST(NodeClasses, TheMarkerOfTheVesselMovesWithThePatient)
{
  ros::NodeHandle node;
  const scene::Scene scene = sceneFromParameters(node);
  const VesselServerNode server(node, scene);
  const VisualizationNode visualization(node, ros::NodeHandle("~"));
  const MarkerListener listener(names::kVesselMarker);
  ros::Publisher publisher = node.advertise<MotionState>(names::kMotionState, 10);
  const geometry::TriangleMesh rest =
      scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired).mesh;
  const auto error = [&](const motion::MotionMap& map)
  {
    const visualization_msgs::MarkerConstPtr marker = listener.newest();
    if (!marker || marker->points.size() != 3 * rest.triangles.size())
      return 1.0;
    double largest = 0.0;
    for (std::size_t k = 0; k < marker->points.size(); ++k)
      largest = std::max(
          largest,
          (fromMessage(marker->points[k]) -
           map.position(rest.vertices[static_cast<std::size_t>(rest.triangles[k / 3][static_cast<int>(k % 3)])]))
              .norm());
    return largest;
  };
  waitUntil(10.0, [&] { return error(restingMap()) == 0.0; });
  EXPECT_EQ(error(restingMap()), 0.0) << "at rest before a motion";
  double time = 0.0;
  const auto moves = [&](double shift)
  {
    publisher.publish(motionOfTube(time += 0.1, shift));
    return error(fromMessage(motionOfTube(time, shift))) < 1e-12;
  };
  waitUntil(10.0, [&] { return moves(5e-3); });
  EXPECT_LT(error(fromMessage(motionOfTube(time, 5e-3))), 1e-12);
  EXPECT_GT(error(restingMap()), 4e-3);
}

TEST(NodeClasses, SessionWritesItsReportWhenItIsDestroyed)
{
  ros::NodeHandle node;
  const std::string folder = testing::TempDir() + "/node_classes_" + std::to_string(::getpid());
  ros::NodeHandle parameters("~session");
  parameters.setParam("results", folder);
  {
    const SessionNode session(node, parameters, sceneFromParameters(node));
  }
  EXPECT_TRUE(std::filesystem::exists(folder + "/report.json"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/session.bag"));
  std::filesystem::remove_all(folder);
}

TEST(NodeClasses, FluoroscopyIsConstructed)
{
  ros::NodeHandle node;
  scene::Scene scene = sceneFromParameters(node);
  scene.fluoroscopy.emplace();
  EXPECT_NO_THROW(FluoroscopyNode(node, ros::NodeHandle("~"), scene, [] { return SchedulingGrant(); }));
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim::nodes
