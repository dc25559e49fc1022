#include "simulation/contact_forces.h"

#include <algorithm>
#include <limits>

#include "rod/contact/wall_friction.h"

namespace endovascular_sim::simulation
{
namespace
{

void takeNearer(WallContact& contact, const contact::Feature& feature)
{
  if (feature.gap >= contact.gap)
    return;
  contact.gap = feature.gap;
  contact.position = feature.point;
  contact.triangle = feature.triangle;
}

/** Lists the triangle of a feature at its place by depth [m]. @param depths of the listed triangles */
void touch(int triangle, double depth, WallContact& contact, std::array<double, WallContact::kMostFacets>& depths)
{
  for (std::size_t k = 0; k < depths.size(); ++k)
    if (contact.touched[k] < 0 || depth > depths[k])
    {
      std::swap(triangle, contact.touched[k]);
      std::swap(depth, depths[k]);
    }
}

/** Lists the triangles that touch every contact's node.
 *  @param at_node index of the contact at a node; −1: none */
void listTouched(const Simulation& simulation, const std::vector<int>& at_node, std::vector<WallContact>& contacts)
{
  const std::vector<Eigen::Vector3d>& x = simulation.state().position;
  std::vector<std::array<double, WallContact::kMostFacets>> depths(contacts.size());
  for (const contact::Feature& feature : simulation.contactSet().features)
    for (const int side : {0, 1})
    {
      const double weight = side == 0 ? 1.0 - feature.parameter : feature.parameter;
      const auto edge = static_cast<std::size_t>(feature.edge);
      const int k = at_node[edge + static_cast<std::size_t>(side)];
      if (weight <= 0.0 || k < 0)
        continue;
      const Eigen::Vector3d axis = (1.0 - feature.parameter) * x[edge] + feature.parameter * x[edge + 1];
      touch(feature.triangle, feature.normal.dot(feature.point - axis), contacts[static_cast<std::size_t>(k)],
            depths[static_cast<std::size_t>(k)]);
    }
}

/** Normal force on a node in the vessel at rest: of equal magnitude, along the normal there. */
Eigen::Vector3d restingForce(const Simulation& simulation, const Eigen::Vector3d& force, int node)
{
  if (simulation.motion() == nullptr)
    return force;
  const motion::MotionMap& map = simulation.motion()->patient().map();
  const Eigen::Vector3d& rest = simulation.positionsAtRest()[static_cast<std::size_t>(node)];
  if (map.resting() || map.outside(rest))
    return force;
  const double magnitude = force.norm();
  return magnitude * map.restingNormal(rest, force / magnitude);
}

}  // namespace

Eigen::Vector3d wallFriction(const Simulation& simulation, int node)
{
  return rod::frictionForce(simulation.state(), node, rod::StepperSettings().friction_slip);
}

void wallContacts(const Simulation& simulation, std::vector<WallContact>& contacts)
{
  const rod::State& state = simulation.state();
  const int nodes = simulation.discretisation().nodes();
  std::vector<int> at_node(static_cast<std::size_t>(nodes), -1);  // index of the contact at a node
  contacts.clear();
  for (int i = state.first_node; i < nodes; ++i)
  {
    if (state.wall_force[i].isZero(0.0))
      continue;
    WallContact contact;
    contact.normal_force = state.wall_force[i];
    contact.resting_force = restingForce(simulation, contact.normal_force, i);
    contact.friction_force = wallFriction(simulation, i);
    contact.position = state.position[i];
    contact.node = i;
    contact.gap = std::numeric_limits<double>::infinity();
    at_node[static_cast<std::size_t>(i)] = static_cast<int>(contacts.size());
    contacts.push_back(contact);
  }
  const std::vector<contact::Feature>& features = simulation.contactSet().features;
  for (const contact::Feature& feature : features)
  {
    const int k = at_node[static_cast<std::size_t>(feature.edge) + static_cast<std::size_t>(feature.parameter > 0.5)];
    if (k >= 0)
      takeNearer(contacts[static_cast<std::size_t>(k)], feature);
  }
  // The force of a node without a feature on the near halves of its edges comes from features on the far halves.
  const auto unlisted = [](const WallContact& contact) { return contact.triangle < 0; };
  for (WallContact& contact : contacts)
    if (unlisted(contact))
      for (const contact::Feature& feature : features)
        if (feature.parameter > 0.0 && feature.parameter < 1.0 &&
            contact.node == feature.edge + (feature.parameter > 0.5 ? 0 : 1))
          takeNearer(contact, feature);
  listTouched(simulation, at_node, contacts);
}

std::vector<WallContact> wallContacts(const Simulation& simulation)
{
  std::vector<WallContact> contacts;
  wallContacts(simulation, contacts);
  return contacts;
}

}  // namespace endovascular_sim::simulation
