#include "session/contact_forces.h"

#include <limits>

#include "rod/wall_friction.h"

namespace endovascular_sim::session
{
std::vector<WallContact> wallContacts(const Simulation& simulation)
{
  const rod::State& state = simulation.state();
  std::vector<WallContact> contacts;
  for (int i = state.first_node; i < simulation.discretisation().nodes(); ++i)
  {
    if (state.wall_force[i].isZero(0.0))
      continue;
    WallContact contact;
    contact.normal_force = state.wall_force[i];
    contact.friction_force = rod::frictionForce(state, i, rod::StepperSettings().friction_slip);
    contact.position = state.position[i];
    double smallest = std::numeric_limits<double>::infinity();
    for (const contact::Feature& feature : simulation.contactSet().features)
    {
      const bool touches = feature.edge + (feature.parameter > 0.5 ? 1 : 0) == i;
      if (!touches || feature.gap >= smallest)
        continue;
      smallest = feature.gap;
      contact.position = feature.point;
      contact.triangle = feature.triangle;
    }
    contacts.push_back(contact);
  }
  return contacts;
}

}  // namespace endovascular_sim::session
