#include "rod/contact/contact_transfer.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "rod/contact/wall_compliance.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLargestOffset = 50e-6;  // m
constexpr int kOffsetSweeps = 30;
constexpr double kLeastWeight = 0.01;  // squared weight of the fresh nodes in a contact that changes their offsets

}  // namespace

double ContactTransfer::positionOf(const contact::Feature& feature) const
{
  assert(feature.edge >= 0 && feature.edge + 1 < rod_.nodes());  // the rod is that of the contacts, not yet the new one
  return rod_.position[feature.edge] + feature.parameter * rod_.rest_length[feature.edge];
}

void ContactTransfer::moveFeatures(const Discretisation& to, const NodeRenumbering& renumbering,
                                   std::vector<contact::Feature>& features) const
{
  for (contact::Feature& feature : features)
  {
    if (renumbering.isShift())
    {
      feature.edge += renumbering.shift();
      continue;
    }
    const double position = positionOf(feature);
    const auto after = std::upper_bound(to.position.begin(), to.position.end() - 1, position);
    feature.edge = std::max(0, static_cast<int>(after - to.position.begin()) - 1);
    const double parameter = (position - to.position[feature.edge]) / to.rest_length[feature.edge];
    feature.parameter = std::max(0.0, std::min(1.0, parameter));
  }
}

void ContactTransfer::storeForces(const ContactList& contacts)
{
  stored_.clear();
  for (std::size_t c = 0; c < contacts.springs.size(); ++c)
  {
    const contact::Feature& feature = contacts.set.features[c];
    if (contacts.springs[c].force > 0.0 && !isStiffLayer(feature))
      stored_.push_back({feature.id, positionOf(feature), contacts.springs[c].force});
  }
}

void ContactTransfer::settle(const ContactList& contacts, ContactSprings& springs, State& state)
{
  fresh_.assign(state.wall_offset.size(), false);
  bool changed = false;
  for (int i = 0; i < rod_.nodes(); ++i)
    if (std::isnan(state.wall_offset[i]))
    {
      changed = fresh_[i] = true;
      state.wall_offset[i] = 0.0;
    }
  if (changed)
    springs.collectCrossings(state, contacts);
  const std::vector<contact::Feature>& features = contacts.set.features;
  for (int sweep = 0; changed && sweep < kOffsetSweeps; ++sweep)
    for (int c = 0; c < static_cast<int>(features.size()); ++c)
      if (!isStiffLayer(features[c]))  // a stiff layer moves with the wall's surface
        settleOffset(features[c], springs.springOf(features, c), state.wall_offset);
  stored_.clear();
}

/** Kaczmarz projection for one contact, since two contacts may share their nodes: changes the offsets of its fresh
 *  nodes so that it has its stored force, or, if it had none, no force. */
void ContactTransfer::settleOffset(const contact::Feature& feature, const ContactSpring& spring,
                                   std::vector<double>& offset) const
{
  const int second = std::min(spring.node + 1, rod_.nodes() - 1);
  const double weight0 = fresh_[spring.node] ? spring.weight0 : 0.0;
  const double weight1 = fresh_[second] ? spring.weight1 : 0.0;
  const double weight = weight0 * weight0 + weight1 * weight1;
  if (weight < kLeastWeight)
    return;
  const double force = storedForce(feature);
  const double missing =
      -feature.gap - force / spring.stiffness - spring.weight0 * offset[spring.node] - spring.weight1 * offset[second];
  if (force <= 0.0 && missing <= 0.0)
    return;
  const auto move = [&](int node, double share)
  { offset[node] = std::max(-kLargestOffset, std::min(kLargestOffset, offset[node] + share * missing)); };
  move(spring.node, weight0 / weight);
  move(second, weight1 / weight);
}

/** Force of a contact before the change of nodes [N]; 0 for a new contact. */
double ContactTransfer::storedForce(const contact::Feature& feature) const
{
  const double position = positionOf(feature);
  double force = 0.0;
  double nearest = 0.5 * rod_.rest_length[feature.edge];
  for (const StoredForce& stored : stored_)
  {
    const double distance = std::abs(stored.position - position);
    if (stored.id != feature.id || distance >= nearest)
      continue;
    nearest = distance;
    force = stored.force;
  }
  return force;
}

void ContactTransfer::StoredForce::archive(Archive& archive)
{
  archive(id, position, force);
  if (archive.reading())
    requireFinite(position, force);
}

void ContactTransfer::archive(Archive& archive)
{
  archive(stored_);
}

}  // namespace endovascular_sim::rod
