#include "rod/contact/contact_springs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/archive.h"
#include "rod/contact/wall_compliance.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kStiffLayerFactor = 100.0;  // stiffness of the layer over the penalty stiffness

}  // namespace

void ContactSpring::archive(Archive& archive)
{
  archive(node, weight0, weight1, stiffness, gap, force, reached, resisted, active);
}

ContactSpring ContactSprings::springOf(const std::vector<contact::Feature>& features, int index) const
{
  const contact::Feature& feature = features[index];
  ContactSpring spring;
  spring.node = feature.edge;
  spring.weight0 = 1.0 - feature.parameter;
  spring.weight1 = feature.parameter;
  spring.stiffness = settings_.contact_stiffness;
  spring.gap = feature.gap;
  if (spring.weight0 <= 0.0 && spring.node + 2 < rod_.nodes())
  {
    ++spring.node;
    std::swap(spring.weight0, spring.weight1);
  }
  if (isStiffLayer(feature))
    spring.stiffness *= kStiffLayerFactor;
  else if (std::isfinite(feature.stiffness))
    spring.stiffness = feature.stiffness * tributaryLength(features, index) * shareAtNode(features, index);
  return spring;
}

void ContactSprings::prepare(const State& state, double dt, ContactList& contacts, const contact::WallTravel* wall)
{
  contacts.springs.clear();
  collectCrossings(state, contacts);
  for (std::size_t c = 0; c < contacts.set.features.size(); ++c)
  {
    const contact::Feature& feature = contacts.set.features[c];
    ContactSpring spring = springOf(contacts.set.features, static_cast<int>(c));
    const int second = std::min(spring.node + 1, rod_.nodes() - 1);
    const Eigen::Vector3d velocity =
        spring.weight0 * state.velocity[spring.node] + spring.weight1 * state.velocity[second];
    double approach = dt * feature.normal.dot(velocity);
    if (wall != nullptr)
      approach -= feature.normal.dot(spring.weight0 * wall->displacement[spring.node] +
                                     spring.weight1 * wall->displacement[second]);
    spring.gap += wallOffset(state, feature);
    spring.active = spring.gap + std::min(0.0, approach) < 0.0;
    contacts.springs.push_back(spring);
  }
}

void ContactSprings::collectCrossings(const State& state, const ContactList& contacts)
{
  const std::vector<contact::Feature>& features = contacts.set.features;
  crossings_.clear();
  for (std::size_t c = 0; c < features.size(); ++c)
    if (std::isfinite(features[c].stiffness) && !isStiffLayer(features[c]) && isBetweenNodes(features[c]) &&
        (c < contacts.detected() || features[c].gap + wallOffset(state, features[c]) < 0.0))
      crossings_.push_back(static_cast<int>(c));
  std::sort(
      crossings_.begin(), crossings_.end(),
      [&features](int a, int b)
      {
        const contact::Feature& f = features[a];
        const contact::Feature& g = features[b];
        return f.edge != g.edge ? f.edge < g.edge : f.parameter != g.parameter ? f.parameter < g.parameter : a < b;
      });
}

/** Tributary length of a contact [m]: half the distance to its neighbours. The neighbours are the nodes, and the
 *  contacts between nodes with the same part of the wall. The tributary lengths of a wall add up to the wire's. */
double ContactSprings::tributaryLength(const std::vector<contact::Feature>& features, int index) const
{
  const contact::Feature& feature = features[index];
  const bool crossing = isBetweenNodes(feature);
  const int node = feature.edge + (feature.parameter >= 1.0 ? 1 : 0);
  double length = 0.0;
  if (crossing || node > 0)
    length += lengthTowards(features, index, crossing ? node : node - 1, crossing ? feature.parameter : 1.0, -1);
  if (crossing || node + 1 < rod_.nodes())
    length += lengthTowards(features, index, node, crossing ? feature.parameter : 0.0, 1);
  return length;
}

/** Half the distance on an edge from a contact to its next neighbour [m]. @param direction 1 distal, −1 proximal */
double ContactSprings::lengthTowards(const std::vector<contact::Feature>& features, int index, int edge,
                                     double parameter, int direction) const
{
  double next = direction > 0 ? 1.0 : 0.0;
  const auto begin = std::lower_bound(crossings_.begin(), crossings_.end(), edge,
                                      [&features](int c, int wanted) { return features[c].edge < wanted; });
  for (auto c = begin; c != crossings_.end() && features[*c].edge == edge; ++c)
  {
    const double other = features[*c].parameter;
    const bool same_position = other == parameter && (direction > 0 ? *c > index : *c < index);
    const bool beyond = direction > 0 ? other > parameter && other < next : other < parameter && other > next;
    if (*c != index && (same_position || beyond) && features[*c].normal.dot(features[index].normal) > 0.0)
      next = other;
  }
  return 0.5 * std::abs(next - parameter) * rod_.rest_length[edge];
}

/** Share of the wall's stiffness for one of several features at the same node. Facets that hardly differ are one wall
 *  and share its stiffness; perpendicular facets are two walls. The largest stiffness in any direction is the wall's.
 *  A feature counts in proportion to its penetration depth, so that it appears and vanishes without a jump. */
double ContactSprings::shareAtNode(const std::vector<contact::Feature>& features, int index)
{
  const contact::Feature& own = features[index];
  if (isBetweenNodes(own))
    return 1.0;
  double sum = 1.0;
  const auto add = [&features, &own, &sum](int other)
  {
    const contact::Feature& f = features[other];
    if (f.edge != own.edge || f.parameter != own.parameter || isStiffLayer(f))
      return false;
    const double pressed = f.gap >= 0.0 ? 0.0 : own.gap >= 0.0 ? 1.0 : std::min(1.0, f.gap / own.gap);
    sum += pressed * std::max(0.0, f.normal.dot(own.normal));
    return true;
  };
  for (int k = index - 1; k >= 0 && add(k); --k)
  {
  }
  for (int k = index + 1; k < static_cast<int>(features.size()) && add(k); ++k)
  {
  }
  return 1.0 / sum;
}

void ContactSprings::exertForces(ContactList& contacts, const NodalMotion& motion, State& state) const
{
  for (int i = state.first_node; i < rod_.nodes(); ++i)
    state.wall_force[i].setZero();
  for (std::size_t c = 0; c < contacts.springs.size(); ++c)
  {
    ContactSpring& spring = contacts.springs[c];
    const contact::Feature& feature = contacts.set.features[c];
    const double force = -spring.stiffness * spring.gapAfter(feature.normal, motion);
    spring.force = spring.active ? std::max(0.0, force) : 0.0;
    if (spring.force <= 0.0)
      continue;
    for (int side = 0; side < 2; ++side)
    {
      const double weight = side == 0 ? spring.weight0 : spring.weight1;
      if (weight <= 0.0)
        continue;
      const int node = spring.node + side;
      state.wall_force[node] += (weight * force) * feature.normal;
      state.friction_coefficient[node] = rod_.frictionOn(feature.friction, node);
    }
  }
}

}  // namespace endovascular_sim::rod
