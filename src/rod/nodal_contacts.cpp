#include "rod/nodal_contacts.h"

#include <algorithm>
#include <cmath>

#include "rod/held_wire.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kHardDepth = 3e-5;  // m
constexpr double kHardening = 10.0;
constexpr int kOnlyAddFromPass = 4;  // later passes only add contacts, so that the active set cannot cycle

}  // namespace

void NodalContacts::beginStep(const StepInput& input, contact::ContactSource* source, std::uint32_t& pass,
                              PhaseTimer& timer)
{
  if (input.step != step_ || input.substep == 0)
    step_is_stale_ = false;
  source_ = source;
  pass_ = &pass;
  timer_ = &timer;
  step_ = input.step;
  substep_ = input.substep;
}

void NodalContacts::refresh(const State& state, StepReport& report)
{
  if (source_ && (!valid_ || contacts_.stale))
    detect(state, report);
}

NodalContacts::Spring NodalContacts::springOf(int index) const
{
  const contact::Feature& feature = contacts_.features[index];
  Spring spring;
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
  if (std::isfinite(feature.stiffness))
    spring.stiffness = feature.stiffness * lengthOf(index);
  return spring;
}

/** A rigid wall's spring hardens where the wire is pressed deeper than snaps and jams of ordinary wires press it: the
 *  spring becomes the tangent at the present depth. A stiffer one throughout would make the force noisy. */
void NodalContacts::harden(Spring& spring)
{
  const double beyond = -spring.gap - kHardDepth;
  if (beyond <= 0.0)
    return;
  const double force = spring.stiffness * (kHardDepth + kHardening * beyond);
  spring.stiffness *= kHardening;
  spring.gap = -force / spring.stiffness;
}

void NodalContacts::prepare(const State& state, double dt)
{
  springs_.clear();
  listCrossings();
  for (std::size_t c = 0; c < contacts_.features.size(); ++c)
  {
    const contact::Feature& feature = contacts_.features[c];
    Spring spring = springOf(static_cast<int>(c));
    const int second = std::min(spring.node + 1, rod_.nodes() - 1);
    const Eigen::Vector3d velocity =
        spring.weight0 * state.velocity[spring.node] + spring.weight1 * state.velocity[second];
    spring.gap += spring.weight0 * state.wall_offset[spring.node] + spring.weight1 * state.wall_offset[second];
    if (!std::isfinite(feature.stiffness))
      harden(spring);
    spring.active = spring.gap + std::min(0.0, dt * feature.normal.dot(velocity)) < 0.0;
    springs_.push_back(spring);
  }
}

/** Contacts between the nodes, along the wire. */
void NodalContacts::listCrossings()
{
  const std::vector<contact::Feature>& features = contacts_.features;
  crossings_.clear();
  for (std::size_t c = 0; c < features.size(); ++c)
    if (std::isfinite(features[c].stiffness) && features[c].parameter > 0.0 && features[c].parameter < 1.0)
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

/** Length of wire that a contact stands for: half the way to its neighbours, which are the nodes and the contacts
 *  between nodes with the same part of the wall; so all of them together stand for the wire once [m]. */
double NodalContacts::lengthOf(int index) const
{
  const contact::Feature& feature = contacts_.features[index];
  const bool crossing = feature.parameter > 0.0 && feature.parameter < 1.0;
  const int node = feature.edge + (feature.parameter >= 1.0 ? 1 : 0);
  double length = 0.0;
  if (crossing || node > 0)
    length += lengthTowards(index, crossing ? node : node - 1, crossing ? feature.parameter : 1.0, -1);
  if (crossing || node + 1 < rod_.nodes())
    length += lengthTowards(index, node, crossing ? feature.parameter : 0.0, 1);
  return length;
}

/** Half the distance on an edge from a contact at @p place to its next neighbour, forwards or backwards [m]. */
double NodalContacts::lengthTowards(int index, int edge, double place, int direction) const
{
  const std::vector<contact::Feature>& features = contacts_.features;
  double next = direction > 0 ? 1.0 : 0.0;
  const auto begin = std::lower_bound(crossings_.begin(), crossings_.end(), edge,
                                      [&features](int c, int wanted) { return features[c].edge < wanted; });
  for (auto c = begin; c != crossings_.end() && features[*c].edge == edge; ++c)
  {
    const double other = features[*c].parameter;
    const bool same_place = other == place && (direction > 0 ? *c > index : *c < index);
    const bool beyond = direction > 0 ? other > place && other < next : other < place && other > next;
    if (*c != index && (same_place || beyond) && features[*c].normal.dot(features[index].normal) > 0.0)
      next = other;
  }
  return 0.5 * std::abs(next - place) * rod_.rest_length[edge];
}

/** Change of the gap by a motion. */
double NodalContacts::approach(std::size_t index, const Motion& motion) const
{
  const Spring& spring = springs_[index];
  const Eigen::Vector3d& normal = contacts_.features[index].normal;
  double change = spring.weight0 * normal.dot(motion[spring.node]);
  if (spring.weight1 > 0.0)
    change += spring.weight1 * normal.dot(motion[spring.node + 1]);
  return change;
}

bool NodalContacts::updateActiveSet(const Motion& motion, int pass)
{
  bool changed = false;
  for (std::size_t c = 0; c < springs_.size(); ++c)
  {
    const bool active = springs_[c].gap + approach(c, motion) < 0.0;
    if (active == springs_[c].active || (!active && pass >= kOnlyAddFromPass))
      continue;
    springs_[c].active = active;
    changed = true;
  }
  return changed;
}

double NodalContacts::truncation(const State& state, const Motion& motion, double factor, StepReport& report)
{
  if (!source_)
    return factor;
  if (contacts_.stale)
    return std::min(factor, staleTruncation(motion));
  for (int i = state.first_node; i < rod_.nodes(); ++i)
    if (motion[i].norm() > settings_.contact_margin)
      return std::min(factor, freeDistanceTruncation(state, motion, report));
  return factor;
}

double NodalContacts::freeDistanceTruncation(const State& state, const Motion& motion, StepReport& report)
{
  ask(state, true, free_distances_, report);
  double factor = 1.0;
  for (int j = query_.first_node; j + 1 < rod_.nodes(); ++j)
  {
    const auto e = static_cast<std::size_t>(j - free_distances_.first_edge);
    const bool known = !free_distances_.stale && e < free_distances_.free_distance.size();
    const double allowed = std::max(settings_.contact_margin, known ? free_distances_.free_distance[e] : 0.0);
    const double farthest = std::max(motion[j].norm(), motion[j + 1].norm());
    if (farthest > allowed)
      factor = std::min(factor, allowed / farthest);
  }
  return factor;
}

/** Old features cover only the margin around the state they were found at: all motion since then is spent from it. */
double NodalContacts::staleTruncation(const Motion& motion)
{
  double farthest = 0.0;
  for (int i = query_.first_node; i < rod_.nodes(); ++i)
    farthest = std::max(farthest, motion[i].norm());
  const double factor = farthest > stale_budget_ ? stale_budget_ / farthest : 1.0;
  stale_budget_ -= factor * farthest;
  return factor;
}

void NodalContacts::updateWallForces(State& state, const Motion& motion)
{
  for (int i = state.first_node; i < rod_.nodes(); ++i)
    state.wall_force[i].setZero();
  for (std::size_t c = 0; c < springs_.size(); ++c)
  {
    const contact::Feature& feature = contacts_.features[c];
    const double force = -springs_[c].stiffness * (springs_[c].gap + approach(c, motion));
    springs_[c].force = springs_[c].active ? std::max(0.0, force) : 0.0;
    if (springs_[c].force <= 0.0)
      continue;
    for (int side = 0; side < 2; ++side)
    {
      const double weight = side == 0 ? springs_[c].weight0 : springs_[c].weight1;
      if (weight <= 0.0)
        continue;
      const int node = springs_[c].node + side;
      state.wall_force[node] += (weight * force) * feature.normal;
      state.friction_coefficient[node] = std::isnan(rod_.friction[node]) ? feature.friction : rod_.friction[node];
    }
  }
}

void NodalContacts::detect(const State& state, StepReport& report)
{
  std::swap(contacts_, previous_contacts_);
  std::swap(springs_, previous_springs_);
  ask(state, false, contacts_, report);
  valid_ = true;
  if (!contacts_.stale)
  {
    stale_budget_ = settings_.contact_margin;
    return;
  }
  contacts_.features = previous_contacts_.features;
  for (contact::Feature& feature : contacts_.features)
  {
    const double t = feature.parameter;
    const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
    const Eigen::Vector3d axis = (1.0 - t) * state.position[feature.edge] + t * state.position[next];
    const double radius = (1.0 - t) * rod_.radius[feature.edge] + t * rod_.radius[next];
    feature.gap = feature.normal.dot(axis - feature.point) - radius;
  }
}

void NodalContacts::ask(const State& state, bool want_free_distance, contact::ContactSet& answer, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  query_.step = step_;
  query_.substep = substep_;
  query_.pass = *pass_;
  query_.want_free_distance = want_free_distance;
  query_.margin = settings_.contact_margin;
  HeldWire(rod_, boundary_).describe(state, query_);
  // Once an answer has failed to come, the rest of the step makes do without: a replay then needs one number only.
  answer.stale = step_is_stale_;
  if (!step_is_stale_)
    source_->detect(query_, answer);
  if (answer.stale && !step_is_stale_)
    report.first_stale_pass = *pass_;
  step_is_stale_ = answer.stale;
  ++*pass_;
}

bool NodalContacts::foundUnknown() const
{
  for (const contact::Feature& feature : contacts_.features)
  {
    if (feature.gap >= -settings_.penetration_tolerance)
      continue;
    bool known = false;
    for (std::size_t c = 0; c < previous_springs_.size() && !known; ++c)
      known = previous_springs_[c].active && previous_contacts_.features[c].id == feature.id &&
              std::abs(previous_contacts_.features[c].edge + previous_contacts_.features[c].parameter - feature.edge -
                       feature.parameter) < 1.0;
    if (!known)
      return true;
  }
  return false;
}

}  // namespace endovascular_sim::rod
