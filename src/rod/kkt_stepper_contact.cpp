#include <algorithm>
#include <cmath>

#include "rod/held_wire.h"
#include "rod/kkt_stepper.h"

// The part of the scheme that deals with contact: active set, trust region, lagged wall forces, asking for contact
// sets.

namespace endovascular_sim::rod
{
namespace
{

constexpr int kMaxActiveSetPasses = 8;
constexpr int kOnlyAddFromPass = 4;  // later passes only add contacts, so that the active set cannot cycle
constexpr double kQuietTurn = 0.01;  // rad of an edge in one solve: less cannot fold anything
constexpr double kSharpTurn = 0.6;   // 1 + cos of a turning angle (114°) below which folding is watched for
constexpr int kMaxFoldHalvings = 10;
constexpr double kBackingDepth = 40e-6;      // m into a rigid wall from where on it is stiffer
constexpr double kBackingStiffness = 100.0;  // times the rigid wall's
constexpr double kLeastCover = 0.1e-3;       // m of the wire's radius that a soft wall leaves in the lumen
constexpr double kDeepest = 80e-6;           // m into a rigid wall that no motion exceeds
constexpr int kMaxDepthHalvings = 6;
constexpr double kShift = 10.0;  // of the mass matrix, when a factorisation has the wrong inertia

bool isBacking(const contact::Feature& feature)
{
  return feature.id < 0;
}

}  // namespace

bool KktStepper::solveActiveSet(const State& state, double dt, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kSolve);
  double shift = 0.0;
  for (int active_pass = 0; active_pass < kMaxActiveSetPasses; ++active_pass)
  {
    matrix_.copyFrom(base_);
    rhs_ = base_rhs_;
    for (std::size_t c = 0; c < active_.size(); ++c)
      if (active_[c].active)
        addContact(contacts_.features[c], active_[c], dt);
    for (int i = first_; shift > 0.0 && i < rod_.nodes(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        matrix_.at(row(i) + axis, row(i) + axis) += shift * rod_.mass[i];
    if (!factoriseAndSolve(state, report))
    {
      if (shift > 0.0)
        return false;
      shift = kShift;
      continue;
    }
    if (!updateActiveSet(active_pass))
      return true;
  }
  return true;
}

void KktStepper::addContact(const contact::Feature& feature, const ActiveContact& contact, double dt)
{
  const double stiffness = dt * dt * contact.stiffness;
  const double push = -stiffness * feature.gap;
  const int r0 = row(contact.node);
  const int r1 = contact.weight1 > 0.0 ? row(contact.node + 1) : r0;
  for (int col = 0; col < 3; ++col)
  {
    rhs_[r0 + col] += contact.weight0 * push * feature.normal[col];
    for (int line = col; line < 3; ++line)
      matrix_.at(r0 + line, r0 + col) +=
          stiffness * contact.weight0 * contact.weight0 * feature.normal[line] * feature.normal[col];
    if (contact.weight1 <= 0.0)
      continue;
    rhs_[r1 + col] += contact.weight1 * push * feature.normal[col];
    for (int line = col; line < 3; ++line)
      matrix_.at(r1 + line, r1 + col) +=
          stiffness * contact.weight1 * contact.weight1 * feature.normal[line] * feature.normal[col];
    for (int line = 0; line < 3; ++line)
      matrix_.at(r1 + line, r0 + col) +=
          stiffness * contact.weight0 * contact.weight1 * feature.normal[line] * feature.normal[col];
  }
}

double KktStepper::contactMotion(std::size_t index) const
{
  const ActiveContact& contact = active_[index];
  const Eigen::Vector3d& normal = contacts_.features[index].normal;
  double motion = contact.weight0 * normal.dot(increment(contact.node));
  if (contact.weight1 > 0.0)
    motion += contact.weight1 * normal.dot(increment(contact.node + 1));
  return motion;
}

bool KktStepper::updateActiveSet(int active_pass)
{
  bool changed = false;
  for (std::size_t c = 0; c < active_.size(); ++c)
  {
    const bool active = contacts_.features[c].gap + contactMotion(c) < 0.0;
    if (active == active_[c].active || (!active && active_pass >= kOnlyAddFromPass))
      continue;
    active_[c].active = active;
    changed = true;
  }
  return changed;
}

void KktStepper::prepareContacts(const State& state, double dt)
{
  active_.clear();
  for (const contact::Feature& feature : contacts_.features)
  {
    ActiveContact contact{feature.edge, 1.0 - feature.parameter, feature.parameter, settings_.contact_stiffness, false};
    if (contact.weight0 <= 0.0 && contact.node + 2 < rod_.nodes())
    {
      ++contact.node;
      std::swap(contact.weight0, contact.weight1);
    }
    const int second = std::min(contact.node + 1, rod_.nodes() - 1);
    if (isBacking(feature))
      contact.stiffness *= kBackingStiffness;
    else if (std::isfinite(feature.stiffness))
      contact.stiffness = feature.stiffness * (contact.weight0 * rod_.cell_length[contact.node] +
                                               contact.weight1 * rod_.cell_length[second]);
    const Eigen::Vector3d velocity =
        contact.weight0 * state.velocity[contact.node] + contact.weight1 * state.velocity[second];
    contact.active = feature.gap + std::min(0.0, dt * feature.normal.dot(velocity)) < 0.0;
    active_.push_back(contact);
  }
}

double KktStepper::truncation(const State& state, StepReport& report)
{
  double factor = 1.0;
  bool far = false;
  double largest_turn = 0.0;  // squared, until all are seen
  const double margin = settings_.contact_margin;
  for (int j = first_; j + 1 < rod_.nodes(); ++j)
  {
    // Along the edge the solve restores what the hand's motion took from a short one: no rotation.
    const Eigen::Vector3d edge = state.position[j + 1] - state.position[j];
    const Eigen::Vector3d change = increment(j + 1) - increment(j);
    const double along = change.dot(edge);
    const double across = std::max(0.0, change.squaredNorm() - along * along / edge.squaredNorm());
    largest_turn = std::max(largest_turn, across / (rod_.rest_length[j] * rod_.rest_length[j]));
    far = far || increment(j).squaredNorm() > margin * margin || increment(j + 1).squaredNorm() > margin * margin;
  }
  largest_turn = std::sqrt(largest_turn);
  if (largest_turn > settings_.max_rotation)
    factor = settings_.max_rotation / largest_turn;
  if (largest_turn > kQuietTurn)
    factor = foldTruncation(state, factor);
  if (source_ && contacts_.stale)
    factor = std::min(factor, staleTruncation());
  else if (source_ && far)
    factor = std::min(factor, freeDistanceTruncation(state, report));
  report.truncations += factor < 1.0;
  return factor;
}

/** No two neighbouring edges may come closer to folding back onto each other than by half of what is left: the bending
 *  energy is infinite there, and beyond it the curvature binormal has changed its side. */
double KktStepper::foldTruncation(const State& state, double factor) const
{
  for (int halving = 0; halving < kMaxFoldHalvings; ++halving)
  {
    bool folds = false;
    for (int i = first_ + 1; i + 1 < rod_.nodes() && !folds; ++i)
    {
      const Eigen::Vector3d e = state.position[i] - state.position[i - 1];
      const Eigen::Vector3d g = state.position[i + 1] - state.position[i];
      const Eigen::Vector3d new_e = e + factor * (increment(i) - increment(i - 1));
      const Eigen::Vector3d new_g = g + factor * (increment(i + 1) - increment(i));
      // 1 + cos of the turning angle: 2 for a straight wire, 0 for a fold.
      const double now = 1.0 + e.dot(g) / std::sqrt(e.squaredNorm() * g.squaredNorm());
      const double then = 1.0 + new_e.dot(new_g) / std::sqrt(new_e.squaredNorm() * new_g.squaredNorm());
      folds = then < kSharpTurn && then < 0.5 * now;
    }
    if (!folds)
      break;
    factor *= 0.5;
  }
  return factor;
}

double KktStepper::freeDistanceTruncation(const State& state, StepReport& report)
{
  ask(state, true, free_distances_, report);
  double factor = 1.0;
  for (int j = query_.first_node; j + 1 < rod_.nodes(); ++j)
  {
    const auto e = static_cast<std::size_t>(j - free_distances_.first_edge);
    const bool known = !free_distances_.stale && e < free_distances_.free_distance.size();
    const double allowed = std::max(settings_.contact_margin, known ? free_distances_.free_distance[e] : 0.0);
    const double motion = std::max(increment(j).norm(), increment(j + 1).norm());
    if (motion > allowed)
      factor = std::min(factor, allowed / motion);
  }
  return factor;
}

/** Old features cover only the margin around the state they were found at: all motion since then is spent from it. */
double KktStepper::staleTruncation()
{
  double motion = 0.0;
  for (int i = query_.first_node; i < rod_.nodes(); ++i)
    motion = std::max(motion, increment(i).norm());
  const double factor = motion > stale_budget_ ? stale_budget_ / motion : 1.0;
  stale_budget_ -= factor * motion;
  return factor;
}

double softWallTravel(double radius)
{
  return std::max(0.5 * radius, radius - kLeastCover);
}

/** Every wall gets stiff behind its surface, as a second feature there: a rigid one, whose spring would else give way
 *  by force over stiffness, and a soft one, before the wire's axis reaches where no contact would be found any more. */
void KktStepper::addBacking()
{
  const std::size_t count = contacts_.features.size();
  for (std::size_t f = 0; f < count; ++f)
  {
    contact::Feature backing = contacts_.features[f];
    const bool soft = std::isfinite(backing.stiffness);
    const double radius = rod_.radius[backing.edge];
    backing.gap += soft ? softWallTravel(radius) : kBackingDepth;
    // A rigid wall's is of use only where its spring is pressed in already.
    if (backing.gap > (soft ? settings_.contact_margin : 0.5 * kBackingDepth))
      continue;
    backing.id = -1 - backing.id;
    contacts_.features.push_back(backing);
  }
}

/** Largest depth in the present contacts with walls that do not give way [m]. */
double KktStepper::deepest() const
{
  double depth = 0.0;
  for (const contact::Feature& feature : contacts_.features)
    if (isBacking(feature) || !std::isfinite(feature.stiffness))
      depth = std::max(depth, -feature.gap);
  return depth;
}

/** Moves the wire by a share of the solution and finds the contacts there. A motion that would put the wire deeper into
 *  a rigid wall than it is, and deeper than is tolerated, is halved until it does not: from a state inside, whatever
 * the solution is, only states inside are reached.
 *  @return the share that was left */
double KktStepper::move(State& state, double factor, StepReport& report)
{
  const double allowed = std::max(kDeepest, deepest());
  double moved = factor;
  for (int i = first_; i < rod_.nodes(); ++i)
    state.position[i] += factor * increment(i);
  if (!source_)
    return factor;
  detect(state, report);
  for (int halving = 0; !contacts_.stale && deepest() > allowed && moved > 0.0; ++halving)
  {
    const double shorter = halving < kMaxDepthHalvings ? 0.5 * moved : 0.0;
    for (int i = first_; i < rod_.nodes(); ++i)
      state.position[i] -= (moved - shorter) * increment(i);
    moved = shorter;
    ask(state, false, contacts_, report);
    if (contacts_.stale)
      stale_budget_ = 0.0;  // it is not known any more where this set was found
    else
      addBacking();
  }
  report.truncations += moved < factor;
  return moved;
}

/** Lagged forces follow accepted solutions only: a truncated one is not an equilibrium. */
void KktStepper::accept(State& state, double dt)
{
  const double to_force = scale_ / (dt * dt);
  for (int j = first_; j + 1 < rod_.nodes(); ++j)
    state.tension[j] = to_force * rhs_[multiplierRow(j)];
  // The contacts that were solved with: the present ones are those after the motion.
  const auto exchange = [this]
  {
    std::swap(contacts_, previous_contacts_);
    std::swap(active_, previous_active_);
  };
  if (source_)
    exchange();
  updateWallForces(state);
  if (source_)
    exchange();
  updateEndForces(state, dt);
}

void KktStepper::updateWallForces(State& state)
{
  for (int i = first_; i < rod_.nodes(); ++i)
    state.wall_force[i].setZero();
  for (std::size_t c = 0; c < active_.size(); ++c)
  {
    const contact::Feature& feature = contacts_.features[c];
    const double force = -active_[c].stiffness * (feature.gap + contactMotion(c));
    if (!active_[c].active || force <= 0.0)
      continue;
    for (int side = 0; side < 2; ++side)
    {
      const double weight = side == 0 ? active_[c].weight0 : active_[c].weight1;
      if (weight <= 0.0)
        continue;
      const int node = active_[c].node + side;
      state.wall_force[node] += (weight * force) * feature.normal;
      state.friction_coefficient[node] = std::isnan(rod_.friction[node]) ? feature.friction : rod_.friction[node];
    }
  }
}

void KktStepper::detect(const State& state, StepReport& report)
{
  std::swap(contacts_, previous_contacts_);
  std::swap(active_, previous_active_);
  ask(state, false, contacts_, report);
  contacts_valid_ = true;
  if (!contacts_.stale)
  {
    stale_budget_ = settings_.contact_margin;
    addBacking();
    return;
  }
  contacts_.features = previous_contacts_.features;
  contacts_.features.erase(std::remove_if(contacts_.features.begin(), contacts_.features.end(), isBacking),
                           contacts_.features.end());
  for (contact::Feature& feature : contacts_.features)
  {
    const double t = feature.parameter;
    const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
    const Eigen::Vector3d axis = (1.0 - t) * state.position[feature.edge] + t * state.position[next];
    const double radius = (1.0 - t) * rod_.radius[feature.edge] + t * rod_.radius[next];
    feature.gap = feature.normal.dot(axis - feature.point) - radius;
  }
  addBacking();
}

void KktStepper::ask(const State& state, bool want_free_distance, contact::ContactSet& answer, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  query_.step = step_;
  query_.substep = substep_;
  query_.pass = *pass_;
  query_.want_free_distance = want_free_distance;
  query_.margin = settings_.contact_margin;
  const HeldWire held(rod_, boundary_);
  held.describe(state, query_);
  const double mouth = held.describeMouth(state, query_);
  // Once an answer has failed to come, the rest of the step makes do without: a replay then needs one number only.
  answer.stale = step_is_stale_;
  if (!step_is_stale_)
  {
    source_->detect(query_, answer);
    // The first point stood inside of its edge.
    for (contact::Feature& feature : answer.features)
      if (feature.edge == query_.first_node)
        feature.parameter = mouth + (1.0 - mouth) * feature.parameter;
  }
  if (answer.stale && !step_is_stale_)
    report.first_stale_pass = *pass_;
  step_is_stale_ = answer.stale;
  ++*pass_;
}

bool KktStepper::resample(const Discretisation& rod)
{
  // Where the nodes that were asked about are still the same ones, so are their contacts.
  const int added = rod.nodes() - rod_.nodes();
  const bool same = query_.first_node + added >= 0 &&
                    std::equal(rod_.position.begin() + query_.first_node, rod_.position.end(),
                               rod.position.begin() + query_.first_node + added, rod.position.end());
  for (contact::Feature& feature : contacts_.features)
    if (same)
      feature.edge += added;
    else
      moveToSampling(feature, rod);
  contacts_valid_ = contacts_valid_ && same;
  rod_ = rod;
  return true;
}

/** A contact stays at its place along the wire: it serves where the next set comes too late. */
void KktStepper::moveToSampling(contact::Feature& feature, const Discretisation& rod) const
{
  const double place = rod_.position[feature.edge] + feature.parameter * rod_.rest_length[feature.edge];
  const auto after = std::upper_bound(rod.position.begin(), rod.position.end() - 1, place);
  feature.edge = std::max(0, static_cast<int>(after - rod.position.begin()) - 1);
  const double parameter = (place - rod.position[feature.edge]) / rod.rest_length[feature.edge];
  feature.parameter = std::max(0.0, std::min(1.0, parameter));
}

/** True when the last detection shows a contact deeper than tolerated that the last solve did not resist. */
bool KktStepper::foundUnknownContact() const
{
  for (const contact::Feature& feature : contacts_.features)
  {
    if (feature.gap >= -settings_.penetration_tolerance)
      continue;
    bool known = false;
    for (std::size_t c = 0; c < previous_active_.size() && !known; ++c)
      known = previous_active_[c].active && previous_contacts_.features[c].id == feature.id &&
              std::abs(previous_contacts_.features[c].edge + previous_contacts_.features[c].parameter - feature.edge -
                       feature.parameter) < 1.0;
    if (!known)
      return true;
  }
  return false;
}

}  // namespace endovascular_sim::rod
