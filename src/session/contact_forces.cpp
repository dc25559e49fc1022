#include "session/contact_forces.h"

#include <limits>

#include "rod/wall_friction.h"

namespace endovascular_sim::session
{
namespace
{

/** @param k where it is sought first; then where it stands, or would: features come in their order along the wire
 *  @return the contact at a node; null without one */
WallContact* contactAt(std::vector<WallContact>& contacts, int node, std::size_t& k)
{
  while (k < contacts.size() && contacts[k].node < node)
    ++k;
  while (k > 0 && contacts[k - 1].node >= node)
    --k;
  return k < contacts.size() && contacts[k].node == node ? &contacts[k] : nullptr;
}

void takeNearer(WallContact* contact, const contact::Feature& feature)
{
  if (contact == nullptr || feature.gap >= contact->gap)
    return;
  contact->gap = feature.gap;
  contact->position = feature.point;
  contact->triangle = feature.triangle;
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
    contact.friction_force = rod::frictionForce(state, i, rod::StepperSettings().friction_slip);
    contact.position = state.position[i];
    contact.node = i;
    contact.gap = std::numeric_limits<double>::infinity();
    contacts.push_back(contact);
  }
  const std::vector<contact::Feature>& features = simulation.contactSet().features;
  std::size_t k = 0;
  for (const contact::Feature& feature : features)
    takeNearer(contactAt(contacts, feature.edge + (feature.parameter > 0.5 ? 1 : 0), k), feature);
  // A node whose own halves of its edges have none got its force from the far halves.
  const auto unlisted = [](const WallContact& contact) { return contact.triangle < 0; };
  for (WallContact& contact : contacts)
    if (unlisted(contact))
      for (const contact::Feature& feature : features)
        if (feature.parameter > 0.0 && feature.parameter < 1.0 &&
            contact.node == feature.edge + (feature.parameter > 0.5 ? 0 : 1))
          takeNearer(&contact, feature);
}

std::vector<WallContact> wallContacts(const Simulation& simulation)
{
  std::vector<WallContact> contacts;
  wallContacts(simulation, contacts);
  return contacts;
}

}  // namespace endovascular_sim::session
