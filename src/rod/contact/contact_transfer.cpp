#include <algorithm>
#include <cmath>

#include "rod/contact/contact_solver_state.h"

// What becomes of contacts when the nodes change.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLargestOffset = 50e-6;  // m
constexpr int kOffsetSweeps = 30;
constexpr double kSlightWeight = 0.01;  // squared, of fresh nodes in a contact that then does not ask for an offset

}  // namespace

void ContactSolver::resample(const Discretisation& to)
{
  const int added = to.nodes() - rod_.nodes();
  const bool same =
      query_.first_node + added >= 0 && std::equal(rod_.position.begin() + query_.first_node, rod_.position.end(),
                                                   to.position.begin() + query_.first_node + added, to.position.end());
  for (contact::Feature& feature : contacts_.features)
    if (same)
      feature.edge += added;
    else
      moveToSampling(feature, to);
  valid_ = valid_ && same;
  for (std::vector<double>* of_nodes : {&radii_, &margins_, &reaches_})
    if (!same)
      of_nodes->clear();
    else if (!of_nodes->empty())
      moveNodes(added, *of_nodes);
  for (NodeRange* fast : {&fast_, &fast_before_, &margin_rule_.snap})
    *fast = same && !fast->empty() ? NodeRange{std::max(0, fast->begin + added), fast->end + added} : NodeRange{};
  mouth_edge_ = same && mouth_edge_ >= 0 ? mouth_edge_ + added : -1;
  carry();
}

/** Nodes have come or gone before those that were asked about. */
void ContactSolver::moveNodes(int added, std::vector<double>& of_nodes)
{
  if (added > 0)
    of_nodes.insert(of_nodes.begin(), static_cast<std::size_t>(added), of_nodes.front());
  else
    of_nodes.erase(of_nodes.begin(), of_nodes.begin() - added);
}

void ContactSolver::moveToSampling(contact::Feature& feature, const Discretisation& to) const
{
  const double place = rod_.position[feature.edge] + feature.parameter * rod_.rest_length[feature.edge];
  const auto after = std::upper_bound(to.position.begin(), to.position.end() - 1, place);
  feature.edge = std::max(0, static_cast<int>(after - to.position.begin()) - 1);
  const double parameter = (place - to.position[feature.edge]) / to.rest_length[feature.edge];
  feature.parameter = std::max(0.0, std::min(1.0, parameter));
}

/** Keeps what the last step's contacts pushed with, by their places along the wire. */
void ContactSolver::carry()
{
  carried_.clear();
  for (std::size_t c = 0; c < previous_springs_.size(); ++c)
  {
    const contact::Feature& feature = previous_contacts_.features[c];
    if (previous_springs_[c].force > 0.0 && feature.id >= 0)
      carried_.push_back({feature.id, rod_.position[feature.edge] + feature.parameter * rod_.rest_length[feature.edge],
                          previous_springs_[c].force});
  }
}

/** After a change of nodes: contacts go on with the forces that they had. A node that was put between two others would
 *  else be pushed at once by the wall that the arc, but not the chord, reaches into. */
void ContactSolver::settle(State& state)
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
    listCrossings(state);
  for (int sweep = 0; changed && sweep < kOffsetSweeps; ++sweep)
    for (int c = 0; c < static_cast<int>(contacts_.features.size()); ++c)
      settleOffset(c, state.wall_offset);
  carried_.clear();
}

/** Moves the offsets of the fresh nodes at a contact to where it pushes with the force that it had, or, if it had none,
 *  no more (Kaczmarz's method: two contacts may share their nodes). */
void ContactSolver::settleOffset(int index, std::vector<double>& offset) const
{
  const contact::Feature& feature = contacts_.features[index];
  if (feature.id < 0)
    return;  // the stiff part behind a wall's surface moves with it
  const Spring contact = springOf(index);
  const int second = std::min(contact.node + 1, rod_.nodes() - 1);
  const double weight0 = fresh_[contact.node] ? contact.weight0 : 0.0;
  const double weight1 = fresh_[second] ? contact.weight1 : 0.0;
  const double weight = weight0 * weight0 + weight1 * weight1;
  if (weight < kSlightWeight)
    return;
  const double force = carriedForce(feature);
  const double missing = -feature.gap - force / contact.stiffness - contact.weight0 * offset[contact.node] -
                         contact.weight1 * offset[second];
  if (force <= 0.0 && missing <= 0.0)
    return;
  const auto move = [&](int node, double share)
  { offset[node] = std::max(-kLargestOffset, std::min(kLargestOffset, offset[node] + share * missing)); };
  move(contact.node, weight0 / weight);
  move(second, weight1 / weight);
}

/** Force that a contact had before the change of nodes; 0 when it is new [N]. */
double ContactSolver::carriedForce(const contact::Feature& feature) const
{
  const double place = rod_.position[feature.edge] + feature.parameter * rod_.rest_length[feature.edge];
  double force = 0.0;
  double nearest = 0.5 * rod_.rest_length[feature.edge];
  for (const Carried& carried : carried_)
  {
    const double distance = std::abs(carried.place - place);
    if (carried.id != feature.id || distance >= nearest)
      continue;
    nearest = distance;
    force = carried.force;
  }
  return force;
}

}  // namespace endovascular_sim::rod
