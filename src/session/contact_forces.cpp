#include "session/contact_forces.h"

#include <algorithm>
#include <limits>

namespace endovascular_sim::session
{
namespace
{

Eigen::Vector3d frictionOn(const rod::State& state, int node)
{
  const double force = state.wall_force[node].norm();
  const Eigen::Vector3d normal = state.wall_force[node] / force;
  const Eigen::Vector3d sliding = state.velocity[node] - state.velocity[node].dot(normal) * normal;
  const double slowest = rod::StepperSettings().friction_speed;  // slower sliding is shared out linearly
  return -(state.friction_coefficient[node] * force / std::max(sliding.norm(), slowest)) * sliding;
}

}  // namespace

void wallContacts(const Simulation& simulation, std::vector<WallContact>& contacts)
{
  const rod::State& state = simulation.state();
  contacts.clear();
  for (int i = state.first_node; i < simulation.discretisation().nodes(); ++i)
  {
    if (state.wall_force[i].isZero(0.0))
      continue;
    WallContact contact;
    contact.normal_force = state.wall_force[i];
    contact.friction_force = frictionOn(state, i);
    contact.position = state.position[i];
    contact.node = i;
    contact.gap = std::numeric_limits<double>::infinity();
    contacts.push_back(contact);
  }
  for (const contact::Feature& feature : simulation.contactSet().features)
  {
    const int node = feature.edge + (feature.parameter > 0.5 ? 1 : 0);
    const auto contact = std::lower_bound(contacts.begin(), contacts.end(), node,
                                          [](const WallContact& c, int wanted) { return c.node < wanted; });
    if (contact == contacts.end() || contact->node != node || feature.gap >= contact->gap)
      continue;
    contact->gap = feature.gap;
    contact->position = feature.point;
    contact->triangle = feature.triangle;
  }
}

std::vector<WallContact> wallContacts(const Simulation& simulation)
{
  std::vector<WallContact> contacts;
  wallContacts(simulation, contacts);
  return contacts;
}

}  // namespace endovascular_sim::session
