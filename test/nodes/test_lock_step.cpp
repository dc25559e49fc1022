#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include <crtk_msgs/OperatingState.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "contact/detector.h"
#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/DriveApplied.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"
#include "results/session_sample.h"
#include "results/wall_force_map.h"
#include "simulation/replay_source.h"
#include "simulation/simulation.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{
namespace
{

/** Listener to all topics of the rod. */
class Listener
{
public:
  explicit Listener(const std::string& instrument)
  {
    const std::string topics = nodes::names::kInstruments + instrument;
    observer_.subscribe<DriveApplied>(nodes::names::kDriveApplied,
                                      [this](const DriveApplied& message)
                                      {
                                        steps_[message.step] = message;
                                        last_step_stamp_ = message.header.stamp.toSec();
                                      });
    observer_.subscribe<ContactForceMap>(nodes::names::kContactForceMap,
                                         [this](const ContactForceMap& message) { newest_map_ = message; });
    observer_.subscribe<sensor_msgs::JointState>(topics + nodes::names::kSetpointJs,
                                                 [this](const sensor_msgs::JointState& message)
                                                 {
                                                   const double force = message.effort.at(0);
                                                   if (force == 0.0 && force_ != 0.0)
                                                     zero_force_stamp_ = message.header.stamp.toSec();
                                                   largest_change_ =
                                                       std::max(largest_change_, std::abs(force - force_));
                                                   force_ = force;
                                                 });
    observer_.subscribe<crtk_msgs::OperatingState>(topics + nodes::names::kOperatingState,
                                                   [this](const crtk_msgs::OperatingState& message)
                                                   { operating_ = message.state; });
  }

  std::map<std::uint64_t, DriveApplied> steps() const { return observer_.copy(steps_); }
  double force() const { return observer_.copy(force_); }
  std::optional<ContactForceMap> newestMap() const { return observer_.copy(newest_map_); }
  std::string operatingState() const { return observer_.copy(operating_); }

  /** Time from the last step before a pause to the first zero force [s]. */
  double timeToZeroForce() const
  {
    const std::lock_guard<std::mutex> lock(observer_.mutex());
    return zero_force_stamp_ - last_step_stamp_;
  }

  /** Largest change of the force between two messages since the last call [N]. */
  double largestChange()
  {
    const std::lock_guard<std::mutex> lock(observer_.mutex());
    return std::exchange(largest_change_, 0.0);
  }

private:
  std::map<std::uint64_t, DriveApplied> steps_;
  std::optional<ContactForceMap> newest_map_;
  std::string operating_;
  double force_ = 0.0;
  double zero_force_stamp_ = 0.0;  ///< stamp of the first zero force after the last non-zero one [s]
  double largest_change_ = 0.0;    ///< largest change of the force [N]
  double last_step_stamp_ = 0.0;   ///< stamp of the newest step [s]
  TopicObserver observer_;         ///< last, so that it ends before the data that it takes over
};

class LockStep : public testing::Test
{
protected:
  void SetUp() override
  {
    scene_ = nodes::sceneFromParameters(ros::NodeHandle());
    listener_ = std::make_unique<Listener>(scene_.instruments.front().instrument.name);
    ASSERT_TRUE(waitUntil(60.0, [this] { return listener_->steps().size() > 500; })) << "the graph does not step";
  }

  scene::Scene scene_;
  std::unique_ptr<Listener> listener_;
};

// Must run first: the inputs are compared from step 0 on, without a disturbance.
TEST_F(LockStep, A_GraphEqualsTheOfflineSimulationAtEveryStep)
{
  ASSERT_TRUE(waitUntil(30.0, [this] { return listener_->steps().size() > 2500; }));
  std::optional<ContactForceMap> map;
  ASSERT_TRUE(waitUntil(30.0,
                        [this, &map]
                        {
                          map = listener_->newestMap();
                          return map && map->whole.integral > 0.0 && listener_->steps().count(map->step) > 0;
                        }));
  const std::map<std::uint64_t, DriveApplied> steps = listener_->steps();
  const vessel::Vessel vessel =
      scene::buildVessel(*scene_.vessel, scene_.entry, scene_.file, scene::CentrelineUse::kRequired);
  contact::Detector detector(vessel.mesh, scene::wallLaw(*scene_.vessel));
  simulation::ReplayContactSource source(detector);
  simulation::Simulation simulation(scene_, scene::resolveEntry(scene_.entry, vessel, scene_.file), &source,
                                    &vessel.centreline);
  // The listener may join late: earlier steps are simulated from the script of the scene, which also drives the graph.
  std::uint64_t compared = 0;
  results::WallForceMap wall_forces(scene_.record.wall_force_threshold, vessel);
  bool maps_compared = false;
  while (simulation.steps() <= steps.rbegin()->first)
  {
    const auto known = steps.find(simulation.steps());
    const double end = static_cast<double>(simulation.steps() + 1) * scene_.solver.time_step;
    drive::HandCommand command{scene_.instruments.front().drive.insertionAt(end),
                               scene_.instruments.front().drive.rotationAt(end)};
    source.setFirstStalePass(known != steps.end() ? known->second.first_stale_pass : contact::kNoStalePass);
    if (known != steps.end())
    {
      EXPECT_EQ(known->second.insertion.at(0), command.insertion);
      EXPECT_EQ(known->second.rotation.at(0), command.rotation);
    }
    simulation.step(command);
    results::addStep(wall_forces, simulation, simulation::wallContacts(simulation), scene_.solver.time_step);
    if (simulation.steps() - 1 == map->step)
    {
      maps_compared = true;
      const results::WallForceTotals whole = wall_forces.summary().whole;
      EXPECT_EQ(map->whole.integral, whole.integral);
      EXPECT_EQ(map->whole.peak, whole.peak);
      EXPECT_EQ(map->triangles.size(), wall_forces.touched().size());
    }
    if (known == steps.end())
      continue;
    ASSERT_EQ(known->second.state_hash, simulation.stateHash()) << "step " << known->first;
    ++compared;
  }
  EXPECT_GT(compared, 2000U);
  EXPECT_TRUE(maps_compared);
}

TEST_F(LockStep, B_LossOfTheContactNodePausesWithoutForceUntilItsRestart)
{
  ASSERT_TRUE(waitUntil(10.0, [this] { return listener_->operatingState() == "ENABLED"; }));
  const std::uint64_t before = listener_->steps().rbegin()->first;
  ASSERT_NE(listener_->force(), 0.0);
  [[maybe_unused]] const double peak = std::abs(listener_->force());
  ASSERT_TRUE(killNode("/contact"));
  ASSERT_TRUE(waitUntil(1.0, [this] { return listener_->operatingState() == "PAUSED"; }));
  ASSERT_TRUE(waitUntil(1.0, [this] { return listener_->force() == 0.0; }));
  // The ramp takes 30 ms; the rest is a margin for a busy machine.
  EXPECT_GT(listener_->timeToZeroForce(), 0.0);
  EXPECT_LT(listener_->timeToZeroForce(), 0.1 * kSlowness);
  listener_->largestChange();
  EXPECT_TRUE(waitUntil(30.0, [this] { return listener_->operatingState() == "ENABLED"; }));
  EXPECT_TRUE(waitUntil(30.0, [&] { return listener_->steps().rbegin()->first > before + 500; }));
  EXPECT_TRUE(std::isfinite(listener_->force()));
#ifndef ENDOVASCULAR_SANITIZED  // the subscriber of a sanitized build loses most messages
  // The force returns from zero by 1 % of the peak per step; messages may be lost on a busy machine.
  EXPECT_LT(listener_->largestChange(), 0.5 * peak + 5e-3);
#endif
}

}  // namespace
}  // namespace endovascular_sim
