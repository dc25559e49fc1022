#pragma once

#include <cstdint>
#include <vector>

#include <ros/ros.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "results/wall_force_map.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Tells the graph what the wall bears: the contacts of now, and the map of all steps so far. */
class ContactForcePublisher
{
public:
  /** @param content_hash of the vessel's mesh */
  ContactForcePublisher(ros::NodeHandle& node, const scene::Scene& scene, const vessel::Vessel& vessel,
                        std::uint64_t content_hash);

  /** After every step of the simulation: counts it, and now and then publishes. */
  void publishStep(const simulation::Simulation& simulation);

  /** Publishes the map as it is; also when nobody listens, since it stays latched. */
  void publishMap(const simulation::Simulation& simulation);

private:
  void publishForces(const simulation::Simulation& simulation);

  double time_step_;  ///< [s]
  std::uint64_t forces_every_, map_every_, last_step_;
  results::WallForceMap map_;
  std::vector<simulation::WallContact> contacts_;
  ros::Publisher forces_publisher_, map_publisher_;
  ContactForces forces_message_;
  ContactForceMap map_message_;
};

}  // namespace endovascular_sim::nodes
