#include "session/contact_forces.h"

#include <algorithm>
#include <limits>

#include "rod/wall_friction.h"

namespace endovascular_sim::session
{
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
    contact.friction_force = rod::frictionForce(state, i, rod::StepperSettings().friction_slip);
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
