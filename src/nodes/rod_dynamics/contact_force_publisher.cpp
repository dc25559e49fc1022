#include "nodes/rod_dynamics/contact_force_publisher.h"

#include <algorithm>
#include <cmath>

#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/contact_force_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/contact_forces.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kForcesRate = 60.0;  ///< rate of contact/forces [Hz]
constexpr double kMapRate = 2.0;      ///< rate of contact/force_map [Hz]

std::uint64_t periodInSteps(double rate, double time_step)
{
  return static_cast<std::uint64_t>(std::max(1.0, std::floor(1.0 / (rate * time_step))));
}

}  // namespace

ContactForcePublisher::ContactForcePublisher(ros::NodeHandle& node, const scene::Scene& scene,
                                             const vessel::Vessel& vessel, std::uint64_t content_hash)
  : time_step_(scene.solver.time_step),
    forces_period_(periodInSteps(kForcesRate, time_step_)),
    map_period_(periodInSteps(kMapRate, time_step_)),
    last_step_(static_cast<std::uint64_t>(std::llround(scene.duration / time_step_))),
    samples_(node, scene),
    empty_map_(scene.record.wall_force_threshold, vessel),
    map_(empty_map_),
    forces_publisher_(node.advertise<ContactForces>(names::kContactForces, 2)),
    map_publisher_(node.advertise<ContactForceMap>(names::kContactForceMap, 1, true))
{
  forces_message_.header.frame_id = map_message_.header.frame_id = names::kPatientFrame;
  map_message_.content_hash = content_hash;
}

void ContactForcePublisher::publishStep(const simulation::Simulation& simulation, bool counted, ros::Time now)
{
  simulation::wallContacts(simulation, contacts_);
  if (counted)
  {
    results::addStep(map_, simulation, contacts_, time_step_);
    samples_.publishStep(simulation, contacts_, now);
  }
  if (simulation.steps() % forces_period_ == 0 && forces_publisher_.getNumSubscribers() > 0)
    publishForces(simulation, now);
  // Always published at the scene's last step: a session that ends there would miss the next map.
  if (simulation.steps() == last_step_ ||
      (simulation.steps() % map_period_ == 0 && map_publisher_.getNumSubscribers() > 0))
    publishMap(simulation, now);
}

void ContactForcePublisher::publishForces(const simulation::Simulation& simulation, ros::Time now)
{
  forces_message_.header.stamp = now;
  forces_message_.step = simulation.steps() - 1;
  forces_message_.contacts.clear();
  for (const simulation::WallContact& contact : contacts_)
  {
    ContactForce force;
    force.position = toPoint(contact.position);
    force.normal_force = toVector(contact.normal_force);
    force.friction_force = toVector(contact.friction_force);
    force.triangle = contact.triangle;
    force.region = regionToMessage(map_.regionOf(contact));
    forces_message_.contacts.push_back(force);
  }
  forces_publisher_.publish(forces_message_);
}

void ContactForcePublisher::publishMap(const simulation::Simulation& simulation, ros::Time now)
{
  map_message_.header.stamp = now;
  map_message_.step = simulation.steps() > 0 ? simulation.steps() - 1 : 0;
  toMessage(map_.summary(), map_.touched(), map_message_);
  map_publisher_.publish(map_message_);
}

void ContactForcePublisher::reset()
{
  map_ = empty_map_;
  samples_.reset();
}

}  // namespace endovascular_sim::nodes
