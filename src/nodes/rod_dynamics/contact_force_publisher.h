#pragma once

#include <cstdint>
#include <vector>

#include <ros/ros.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "nodes/rod_dynamics/sample_publisher.h"
#include "results/wall_force_map.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Publisher of the forces on the wall: the contacts of a step, and the map of all steps so far. */
class ContactForcePublisher
{
public:
  /** @param content_hash content hash of the vessel's mesh */
  ContactForcePublisher(ros::NodeHandle& node, const scene::Scene& scene, const vessel::Vessel& vessel,
                        std::uint64_t content_hash);

  /** Adds a step to the map and to the samples of the session, and publishes at the rates of the topics. Call it after
   *  every step.
   *  @param counted false after the end of the procedure: map and samples stay those of its end */
  void publishStep(const simulation::Simulation& simulation, bool counted, ros::Time now);

  /** Reports whether the samples of the session have a subscriber. */
  bool isSampled() const { return samples_.hasSubscriber(); }

  /** Publishes the current map, also without a subscriber: the topic is latched. */
  void publishMap(const simulation::Simulation& simulation, ros::Time now);

  /** Begins a new run: the sums start at zero. */
  void reset();

private:
  void publishForces(const simulation::Simulation& simulation, ros::Time now);

  double time_step_;                                      ///< duration of a step [s]
  std::uint64_t forces_period_, map_period_, last_step_;  ///< [steps]
  SamplePublisher samples_;
  results::WallForceMap empty_map_;  ///< map of a new run
  results::WallForceMap map_;
  std::vector<simulation::WallContact> contacts_;
  ros::Publisher forces_publisher_, map_publisher_;
  ContactForces forces_message_;
  ContactForceMap map_message_;
};

}  // namespace endovascular_sim::nodes
