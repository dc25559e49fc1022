#include "rod/contact/contact_solver_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rod/boundary/boundary_conditions.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kBackingDepth = 40e-6;      // m into a rigid wall from where on it is stiffer
constexpr double kBackingStiffness = 100.0;  // times the rigid wall's
constexpr double kLeastCover = 0.1e-3;       // m of the wire's radius that a soft wall leaves in the lumen
constexpr double kDeepest = 80e-6;           // m into a wall that does not give way that no motion exceeds
constexpr double kShareToAxis = 0.8;         // of the way from there to the wire's axis, where that is less
constexpr int kOnlyAddFromPass = 12;         // later passes only add contacts; those that are left over pull
constexpr int kLineSearchHalvings = 10;

bool isBacking(const contact::Feature& feature)
{
  return feature.id < 0;
}

/** Between two nodes. */
bool isCrossing(const contact::Feature& feature)
{
  return feature.parameter > 0.0 && feature.parameter < 1.0;
}

/** The same part of the wall, near the same place on the wire. */
bool isSame(const contact::Feature& a, const contact::Feature& b)
{
  return a.id == b.id && std::abs(a.edge + a.parameter - b.edge - b.parameter) < 1.0;
}

}  // namespace

double softWallTravel(double radius)
{
  return std::max(0.5 * radius, radius - kLeastCover);
}

void ContactSolver::beginStep(const StepInput& input, contact::ContactSource* source, std::uint32_t& pass,
                              PhaseTimer& timer)
{
  if (input.step != step_ || input.substep == 0)
    step_is_stale_ = false;
  source_ = source;
  pass_ = &pass;
  timer_ = &timer;
  wide_motion_ *= 0.5;
  fast_before_ = fast_;
  fast_ = {};
  step_ = input.step;
  substep_ = input.substep;
  vessel_version_ = input.vessel_version;
}

double ContactSolver::radiusOf(int node) const
{
  return radii_.empty() ? rod_.radius[node] : std::max(rod_.radius[node], radii_[node]);
}

/** Of the wire, where it touches [m]. */
double ContactSolver::radiusAt(const contact::Feature& feature) const
{
  const double first = rod_.radius[feature.edge];
  const double second = rod_.radius[std::min(feature.edge + 1, rod_.nodes() - 1)];
  return first == second ? first : (1.0 - feature.parameter) * first + feature.parameter * second;
}

/** What is asked about is as wide as what the wire carries. */
void ContactSolver::widen()
{
  for (std::size_t i = 0; i < query_.radius.size() && !radii_.empty(); ++i)
    query_.radius[i] = std::max(query_.radius[i], radii_[static_cast<std::size_t>(query_.first_node) + i]);
}

void ContactSolver::refresh(const State& state, StepReport& report)
{
  if (source_ && (!valid_ || contacts_.stale))
    detect(state, report);
}

ContactSolver::Spring ContactSolver::springOf(int index) const
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
  if (isBacking(feature))
    spring.stiffness *= kBackingStiffness;
  else if (std::isfinite(feature.stiffness))
    spring.stiffness = feature.stiffness * lengthOf(index) * shareAtNode(index);
  return spring;
}

/** Every wall gets stiff behind its surface, as a second feature there: a rigid one, whose spring would else give way
 *  by force over stiffness, and a soft one, before the wire's axis reaches where no contact would be found any more. */
void ContactSolver::addStiffLayer()
{
  const std::size_t count = contacts_.features.size();
  for (std::size_t f = 0; f < count; ++f)
  {
    contact::Feature backing = contacts_.features[f];
    const bool soft = std::isfinite(backing.stiffness);
    backing.gap += soft ? softWallTravel(radiusAt(backing)) : kBackingDepth;
    // A rigid wall's is of use only where its spring is pressed in already.
    const int next = std::min(backing.edge + 1, rod_.nodes() - 1);
    const double reach = std::max({settings_.contact_margin, marginOf(backing.edge), marginOf(next)});
    if (backing.gap > (soft ? reach : 0.5 * kBackingDepth))
      continue;
    backing.id = -1 - backing.id;
    contacts_.features.push_back(backing);
  }
}

void ContactSolver::removeStiffLayer()
{
  contacts_.features.erase(std::remove_if(contacts_.features.begin(), contacts_.features.end(), isBacking),
                           contacts_.features.end());
}

/** By how much a node's surface grows where it gets another least radius [m]. */
double ContactSolver::growthTo(double radius, int node) const
{
  return std::max(rod_.radius[node], radius) - radiusOf(node);
}

void ContactSolver::setRadii(const std::vector<double>& radii)
{
  if (radii_.size() == radii.size())
  {
    releaseRetained();
    removeStiffLayer();
    spendMargins(radii);
    for (contact::Feature& feature : contacts_.features)
    {
      const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
      feature.gap -= (1.0 - feature.parameter) * growthTo(radii[feature.edge], feature.edge) +
                     feature.parameter * growthTo(radii[next], next);
    }
    addStiffLayer();
  }
  radii_ = radii;
}

/** By how much a contact is deeper than is tolerated, where the wall does not give way; else 0 [m]. */
double ContactSolver::excessDepth(const contact::Feature& feature) const
{
  const bool rigid = isBacking(feature) || !std::isfinite(feature.stiffness);
  return rigid ? std::max(0.0, -feature.gap - toleratedDepth(feature)) : 0.0;
}

void ContactSolver::noteDepths()
{
  depths_.assign(static_cast<std::size_t>(rod_.nodes()), 0.0);
  for (std::size_t f = 0; f + kept_ < contacts_.features.size(); ++f)
  {
    const contact::Feature& feature = contacts_.features[f];
    const double depth = excessDepth(feature);
    const bool in_mouth = feature.edge == mouth_edge_ && feature.parameter <= mouth_;
    if (feature.parameter < 1.0)
      depths_[feature.edge] = std::max(depths_[feature.edge], depth);
    if (feature.parameter > 0.0 && !in_mouth)
      depths_[feature.edge + 1] = std::max(depths_[feature.edge + 1], depth);
  }
}

/** Node by node: what is pressed in at one place, in the introducer's mouth for instance, is no leave for others. */
bool ContactSolver::isDeeper() const
{
  for (std::size_t f = 0; f + kept_ < contacts_.features.size(); ++f)
  {
    const contact::Feature& feature = contacts_.features[f];
    const double excess = excessDepth(feature);
    const double first = feature.parameter < 1.0 ? depths_[feature.edge] : 0.0;
    const double second = feature.parameter > 0.0 ? depths_[feature.edge + 1] : 0.0;
    if (excess > std::max(first, second))
      return true;
  }
  return false;
}

double ContactSolver::toleratedDepth(const contact::Feature& feature) const
{
  const double radius = radiusAt(feature);
  const double to_axis = std::isfinite(feature.stiffness) ? radius - softWallTravel(radius) : radius;
  return std::min(kDeepest, kShareToAxis * to_axis);
}

void ContactSolver::prepare(const State& state, double dt)
{
  moved_on_ = false;
  springs_.clear();
  listCrossings(state);
  for (std::size_t c = 0; c < contacts_.features.size(); ++c)
  {
    const contact::Feature& feature = contacts_.features[c];
    Spring spring = springOf(static_cast<int>(c));
    const int second = std::min(spring.node + 1, rod_.nodes() - 1);
    const Eigen::Vector3d velocity =
        spring.weight0 * state.velocity[spring.node] + spring.weight1 * state.velocity[second];
    spring.gap += offsetAt(state, feature);
    spring.active = spring.gap + std::min(0.0, dt * feature.normal.dot(velocity)) < 0.0;
    springs_.push_back(spring);
  }
}

/** Contacts between the nodes, along the wire; of kept ones those that are still pressed. */
void ContactSolver::listCrossings(const State& state)
{
  const std::vector<contact::Feature>& features = contacts_.features;
  crossings_.clear();
  for (std::size_t c = 0; c < features.size(); ++c)
    if (std::isfinite(features[c].stiffness) && !isBacking(features[c]) && isCrossing(features[c]) &&
        (c + kept_ < features.size() || features[c].gap + offsetAt(state, features[c]) < 0.0))
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
double ContactSolver::lengthOf(int index) const
{
  const contact::Feature& feature = contacts_.features[index];
  const bool crossing = isCrossing(feature);
  const int node = feature.edge + (feature.parameter >= 1.0 ? 1 : 0);
  double length = 0.0;
  if (crossing || node > 0)
    length += lengthTowards(index, crossing ? node : node - 1, crossing ? feature.parameter : 1.0, -1);
  if (crossing || node + 1 < rod_.nodes())
    length += lengthTowards(index, node, crossing ? feature.parameter : 0.0, 1);
  return length;
}

/** Share of the wall's stiffness that a node's feature gets where the node touches several: facets that hardly differ
 *  are one wall, and count together as it does, perpendicular ones are two. The largest stiffness in any direction is
 *  the wall's. A feature counts as much as it is pressed in, so that it comes and goes without a jump. */
double ContactSolver::shareAtNode(int index) const
{
  const std::vector<contact::Feature>& features = contacts_.features;
  const contact::Feature& own = features[index];
  if (isCrossing(own))
    return 1.0;
  double sum = 1.0;
  const auto add = [&features, &own, &sum](int other)
  {
    const contact::Feature& f = features[other];
    if (f.edge != own.edge || f.parameter != own.parameter || isBacking(f))
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

/** Half the distance on an edge from a contact at @p place to its next neighbour, forwards or backwards [m]. */
double ContactSolver::lengthTowards(int index, int edge, double place, int direction) const
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
double ContactSolver::approach(const Spring& spring, const Eigen::Vector3d& normal, const Motion& motion) const
{
  double change = spring.weight0 * normal.dot(motion[spring.node]);
  if (spring.weight1 > 0.0)
    change += spring.weight1 * normal.dot(motion[spring.node + 1]);
  return change;
}

bool ContactSolver::updateActiveSet(const Motion& motion, int pass, bool same_rest)
{
  bool changed = false;
  gap_after_.resize(springs_.size());
  for (std::size_t c = 0; c < springs_.size(); ++c)
  {
    gap_after_[c] = springs_[c].gap + approach(springs_[c], contacts_.features[c].normal, motion);
    const bool active = gap_after_[c] < 0.0;
    changed |= active != springs_[c].active && (active || pass < kOnlyAddFromPass);
  }
  if (!changed)
    return false;
  const bool only_add = pass >= kOnlyAddFromPass;
  const double share = same_rest && !only_add ? shareOfLeastEnergy() : 1.0;
  first_changed_ = std::numeric_limits<int>::max();
  for (std::size_t c = 0; c < springs_.size(); ++c)
  {
    Spring& spring = springs_[c];
    const double gap = gap_after_[c];
    const double resisted = spring.active ? spring.stiffness * gap : 0.0;
    spring.reached += share * (gap - spring.reached);
    spring.resisted += share * (resisted - spring.resisted);
    const bool active = spring.reached < 0.0 || (only_add && spring.active);
    if (active != spring.active)
      first_changed_ = std::min(first_changed_, spring.node);
    spring.active = active;
  }
  return true;
}

/** The slope of the energy along the way is the springs' own, piecewise linear, plus that of the rest, linear: at
 * either end the rest balances the springs of the systems solved. */
double ContactSolver::shareOfLeastEnergy()
{
  resisting_.clear();  // all others are open from one end of the way to the other
  for (std::size_t c = 0; c < springs_.size(); ++c)
    if (springs_[c].active || springs_[c].resisted != 0.0 || springs_[c].reached < 0.0 || gap_after_[c] < 0.0)
      resisting_.push_back(c);
  double low = 0.0;
  double high = 1.0;
  for (int k = 0; k <= kLineSearchHalvings; ++k)
  {
    const double share = k == 0 ? 1.0 : 0.5 * (low + high);
    double slope = 0.0;
    for (const std::size_t c : resisting_)
    {
      const Spring& spring = springs_[c];
      const double gap = gap_after_[c];
      const double change = gap - spring.reached;
      const double rest = (1.0 - share) * spring.resisted + (spring.active ? share * spring.stiffness * gap : 0.0);
      slope += change * (spring.stiffness * std::min(0.0, spring.reached + share * change) - rest);
    }
    if (k == 0 && slope <= 0.0)
      return 1.0;
    (slope < 0.0 ? low : high) = share;
  }
  return high;  // beyond the first spring that changes
}

void ContactSolver::updateWallForces(State& state, const Motion& motion)
{
  const std::vector<contact::Feature>& features = (moved_on_ ? previous_contacts_ : contacts_).features;
  std::vector<Spring>& springs = moved_on_ ? previous_springs_ : springs_;
  for (int i = state.first_node; i < rod_.nodes(); ++i)
    state.wall_force[i].setZero();
  for (std::size_t c = 0; c < springs.size(); ++c)
  {
    Spring& spring = springs[c];
    const contact::Feature& feature = features[c];
    const double force = -spring.stiffness * (spring.gap + approach(spring, feature.normal, motion));
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

void ContactSolver::detectAgain(const State& state, StepReport& report)
{
  ask(state, contacts_, report);
  if (contacts_.stale)
    stale_motion_budget_ = 0.0;  // it is not known any more where this set was found
  else
    addStiffLayer();
}

void ContactSolver::detect(const State& state, StepReport& report)
{
  std::swap(contacts_, previous_contacts_);
  std::swap(springs_, previous_springs_);
  kept_before_ = kept_;
  kept_ = 0;
  ask(state, contacts_, report);
  valid_ = moved_on_ = true;
  if (!contacts_.stale)
  {
    stale_motion_budget_ = 1.0;
    addStiffLayer();
    return;
  }
  contacts_.features = previous_contacts_.features;
  contacts_.features.resize(contacts_.features.size() - kept_before_);
  removeStiffLayer();
  for (contact::Feature& feature : contacts_.features)
    feature.gap = gapAt(state, feature);
  addStiffLayer();
}

/** Of a feature that was found at another state, whose wall is taken as a plane [m]. */
double ContactSolver::gapAt(const State& state, const contact::Feature& feature) const
{
  const double t = feature.parameter;
  const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
  const Eigen::Vector3d axis = (1.0 - t) * state.position[feature.edge] + t * state.position[next];
  const double radius = (1.0 - t) * radiusOf(feature.edge) + t * radiusOf(next);
  return feature.normal.dot(axis - feature.point) - radius;
}

/** Shift of a feature's gap that a change of the sampling left [m]. */
double ContactSolver::offsetAt(const State& state, const contact::Feature& feature) const
{
  const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
  return (1.0 - feature.parameter) * state.wall_offset[feature.edge] + feature.parameter * state.wall_offset[next];
}

void ContactSolver::retainActiveContacts(const State& state)
{
  if (contacts_.stale)
    return;
  const std::size_t count = previous_springs_.size();
  const std::size_t found = contacts_.features.size();
  for (std::size_t c = 0; c < count; ++c)
  {
    const contact::Feature& feature = previous_contacts_.features[c];
    const bool pressed =
        feature.gap + offsetAt(state, feature) < 0.0 || previous_springs_[c].active || c + kept_before_ >= count;
    if (!pressed || isBacking(feature) || !isCrossing(feature))
      continue;
    const auto begin = contacts_.features.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(found);
    if (std::any_of(begin, end, [&feature](const contact::Feature& other) { return isSame(feature, other); }))
      continue;
    contacts_.features.push_back(feature);
    contacts_.features.back().gap = gapAt(state, feature);
  }
  kept_ = contacts_.features.size() - found;
}

void ContactSolver::releaseRetained()
{
  contacts_.features.resize(contacts_.features.size() - kept_);
  kept_ = 0;
}

void ContactSolver::ask(const State& state, contact::ContactSet& answer, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  const BoundaryConditions held(rod_, boundary_);
  held.describe(state, query_);
  widen();
  mouth_ = held.describeMouth(state, query_);
  mouth_edge_ = mouth_ > 0.0 ? query_.first_node : -1;
  margin_rule_.widest_margin = wantedWideMargin();
  widenQueryForSnaps();
  send(0.0, answer, report);
  if (answer.stale)
    return;
  // The first point stood inside of its edge.
  for (contact::Feature& feature : answer.features)
    if (feature.edge == query_.first_node)
      feature.parameter = mouth_ + (1.0 - mouth_) * feature.parameter;
  keepMargins();
  keepReaches();
}

/** @param wanted_free_distance 0 in a query for features [m] */
void ContactSolver::send(double wanted_free_distance, contact::ContactSet& answer, StepReport& report)
{
  query_.step = step_;
  query_.substep = substep_;
  query_.pass = *pass_;
  margin_rule_.apply(query_);
  query_.vessel_version = vessel_version_;
  // Once an answer has failed to come, the rest of the step makes do without: a replay then needs one number only.
  answer.stale = step_is_stale_;
  if (!step_is_stale_ && wanted_free_distance > 0.0)
    source_->freeDistances(query_, wanted_free_distance, answer);
  else if (!step_is_stale_)
    source_->detect(query_, answer);
  if (answer.stale && !step_is_stale_)
    report.first_stale_pass = *pass_;
  step_is_stale_ = answer.stale;
  ++*pass_;
}

bool ContactSolver::foundUnknown(const State& state) const
{
  for (const contact::Feature& feature : contacts_.features)
  {
    if (feature.gap + offsetAt(state, feature) >= -settings_.penetration_tolerance)
      continue;
    bool known = false;
    for (std::size_t c = 0; c < previous_springs_.size() && !known; ++c)
      known = previous_springs_[c].active && isSame(previous_contacts_.features[c], feature);
    if (!known)
      return true;
  }
  return false;
}

}  // namespace endovascular_sim::rod
