#include "rod/nodal_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rod/held_wire.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kBackingDepth = 40e-6;      // m into a rigid wall from where on it is stiffer
constexpr double kBackingStiffness = 100.0;  // times the rigid wall's
constexpr double kLeastCover = 0.1e-3;       // m of the wire's radius that a soft wall leaves in the lumen
constexpr double kDeepest = 80e-6;           // m into a wall that does not give way that no motion exceeds
constexpr double kShareToAxis = 0.8;         // of the way from there to the wire's axis, where that is less
constexpr double kWideMargin = 5e-6;         // m of a filled balloon's margin, and
constexpr double kLeastOfMargin = 0.5;       // that growth leaves, so that the wire is not held
constexpr double kWideMotions = 4.0;         // so many times its last motion
constexpr int kOnlyAddFromPass = 12;         // later passes only add contacts; those that are left over pull
constexpr int kLineSearchHalvings = 10;
constexpr double kBeyondMargin = 1.0 + 1e-12;  // for rounding

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

void NodalContacts::beginStep(const StepInput& input, contact::ContactSource* source, std::uint32_t& pass,
                              PhaseTimer& timer)
{
  if (input.step != step_ || input.substep == 0)
    step_is_stale_ = false;
  source_ = source;
  pass_ = &pass;
  timer_ = &timer;
  wide_motion_ *= 0.5;
  step_ = input.step;
  substep_ = input.substep;
  vessel_version_ = input.vessel_version;
}

double NodalContacts::radiusOf(int node) const
{
  return radii_.empty() ? rod_.radius[node] : std::max(rod_.radius[node], radii_[node]);
}

/** Of the wire, where it touches [m]. */
double NodalContacts::radiusAt(const contact::Feature& feature) const
{
  const double first = rod_.radius[feature.edge];
  const double second = rod_.radius[std::min(feature.edge + 1, rod_.nodes() - 1)];
  return first == second ? first : (1.0 - feature.parameter) * first + feature.parameter * second;
}

/** By which a node's surface may come closer to a wall that was not listed [m]. */
double NodalContacts::listedMargin(int node) const
{
  const auto i = static_cast<std::size_t>(node);
  return i < margins_.size() ? margins_[i] : settings_.contact_margin * contact::marginShare(radiusOf(node));
}

/** None of its edges' points then meets what the detector did not list. */
double NodalContacts::marginOf(int node) const
{
  return std::min(
      {listedMargin(std::max(0, node - 1)), listedMargin(node), listedMargin(std::min(node + 1, rod_.nodes() - 1))});
}

/** Of what has just been asked. */
void NodalContacts::keepMargins()
{
  margins_.clear();
  for (int i = 0; i < query_.first_node; ++i)
    margins_.push_back(settings_.contact_margin * contact::marginShare(radiusOf(i)));
  for (std::size_t i = 0; i < query_.nodes.size(); ++i)
    margins_.push_back(query_.marginAt(i));
}

/** The node or a neighbour. */
bool NodalContacts::isWideAt(int node) const
{
  return contact::isWide(
      std::max({radiusOf(std::max(0, node - 1)), radiusOf(node), radiusOf(std::min(node + 1, rod_.nodes() - 1))}));
}

/** Notes the motion of the wide body that moves most. */
void NodalContacts::noteWideMotion(const Motion& motion, int first, double factor)
{
  double most = 0.0;
  for (int i = first; i < rod_.nodes(); ++i)
    if (isWideAt(i))
      most = std::max(most, factor * motion[i].norm());
  wide_motion_ = std::isinf(wide_motion_) ? most : std::max(most, wide_motion_);
}

/** A filled balloon has the whole wall round it and hardly moves: it is asked about as far as it may soon move. */
double NodalContacts::wantedWideMargin() const
{
  bool filled = false;
  for (std::size_t i = 0; i < radii_.size() && !filled; ++i)
    filled = contact::isWide(radii_[i]) && radii_[i] > rod_.radius[i];
  return filled ? kWideMargin + kWideMotions * wide_motion_ : std::numeric_limits<double>::infinity();
}

/** What is asked about is as wide as what the wire carries. */
void NodalContacts::widen()
{
  for (std::size_t i = 0; i < query_.radius.size() && !radii_.empty(); ++i)
    query_.radius[i] = std::max(query_.radius[i], radii_[static_cast<std::size_t>(query_.first_node) + i]);
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
  if (isBacking(feature))
    spring.stiffness *= kBackingStiffness;
  else if (std::isfinite(feature.stiffness))
    spring.stiffness = feature.stiffness * lengthOf(index) * shareAtNode(index);
  return spring;
}

/** Every wall gets stiff behind its surface, as a second feature there: a rigid one, whose spring would else give way
 *  by force over stiffness, and a soft one, before the wire's axis reaches where no contact would be found any more. */
void NodalContacts::addBacking()
{
  const std::size_t count = contacts_.features.size();
  for (std::size_t f = 0; f < count; ++f)
  {
    contact::Feature backing = contacts_.features[f];
    const bool soft = std::isfinite(backing.stiffness);
    backing.gap += soft ? softWallTravel(radiusAt(backing)) : kBackingDepth;
    // A rigid wall's is of use only where its spring is pressed in already.
    if (backing.gap > (soft ? settings_.contact_margin : 0.5 * kBackingDepth))
      continue;
    backing.id = -1 - backing.id;
    contacts_.features.push_back(backing);
  }
}

void NodalContacts::dropBacking()
{
  contacts_.features.erase(std::remove_if(contacts_.features.begin(), contacts_.features.end(), isBacking),
                           contacts_.features.end());
}

void NodalContacts::setRadii(const std::vector<double>& radii)
{
  if (radii_.size() == radii.size())
  {
    dropKept();
    dropBacking();
    for (std::size_t i = 0; i < margins_.size(); ++i)
    {
      const double growth = std::max(0.0, std::max(rod_.radius[i], radii[i]) - radiusOf(static_cast<int>(i)));
      margins_[i] = std::max(kLeastOfMargin * margins_[i], margins_[i] - growth);
      if (contact::isWide(radii[i]))
        wide_motion_ = std::max(wide_motion_, growth);
    }
    for (contact::Feature& feature : contacts_.features)
    {
      const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
      const auto growth = [&](int node) { return std::max(rod_.radius[node], radii[node]) - radiusOf(node); };
      feature.gap -= (1.0 - feature.parameter) * growth(feature.edge) + feature.parameter * growth(next);
    }
    addBacking();
  }
  radii_ = radii;
}

double NodalContacts::tooDeep() const
{
  double depth = 0.0;
  for (std::size_t f = 0; f + kept_ < contacts_.features.size(); ++f)
  {
    const contact::Feature& feature = contacts_.features[f];
    if (isBacking(feature) || !std::isfinite(feature.stiffness))
      depth = std::max(depth, -feature.gap - toleratedDepth(feature));
  }
  return depth;
}

double NodalContacts::toleratedDepth(const contact::Feature& feature) const
{
  const double radius = radiusAt(feature);
  const double to_axis = std::isfinite(feature.stiffness) ? radius - softWallTravel(radius) : radius;
  return std::min(kDeepest, kShareToAxis * to_axis);
}

void NodalContacts::prepare(const State& state, double dt)
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
void NodalContacts::listCrossings(const State& state)
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
double NodalContacts::lengthOf(int index) const
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
double NodalContacts::shareAtNode(int index) const
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
double NodalContacts::approach(const Spring& spring, const Eigen::Vector3d& normal, const Motion& motion) const
{
  double change = spring.weight0 * normal.dot(motion[spring.node]);
  if (spring.weight1 > 0.0)
    change += spring.weight1 * normal.dot(motion[spring.node + 1]);
  return change;
}

bool NodalContacts::updateActiveSet(const Motion& motion, int pass, bool same_rest)
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
double NodalContacts::shareOfLeastEnergy()
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

double NodalContacts::truncation(const State& state, const Motion& motion, double factor, StepReport& report)
{
  if (!source_)
    return factor;
  if (contacts_.stale)
    return std::min(factor, staleTruncation(motion));
  const double margins = marginsIn(motion, state.first_node);
  factor = freshTruncation(state, motion, factor, margins, report);
  noteWideMotion(motion, state.first_node, factor);
  // Should the next set fail to come, this motion counts as well.
  stale_budget_ = std::max(0.0, 1.0 - factor * margins);
  return factor;
}

/** @param margins that the whole motion goes by at most */
double NodalContacts::freshTruncation(const State& state, const Motion& motion, double factor, double margins,
                                      StepReport& report)
{
  if (factor * margins <= 1.0)
    return factor;
  factor = listedTruncation(state, motion, factor);
  if (factor * margins <= kBeyondMargin)
    return factor;
  return freeDistanceTruncation(state, motion, factor, report);
}

/** How many margins the node moves by that moves by the most of its own. */
double NodalContacts::marginsIn(const Motion& motion, int first) const
{
  double most = 0.0;
  for (int i = first; i < rod_.nodes(); ++i)
    most = std::max(most, motion[i].norm() / marginOf(i));
  return most;
}

/** Where a contact is listed the free distance is the margin, and it need not be asked for: mostly that settles it. */
double NodalContacts::listedTruncation(const State& state, const Motion& motion, double factor) const
{
  for (const contact::Feature& feature : contacts_.features)
  {
    const bool at_first = feature.parameter <= 0.0;
    const bool at_second = feature.parameter >= 1.0;
    const int from = std::max(state.first_node, feature.edge - (at_first ? 1 : 0));
    const int to = std::min(rod_.nodes() - 1, feature.edge + (at_second ? 2 : 1));
    for (int i = from; i <= to; ++i)
    {
      const double distance = motion[i].norm();
      const double margin = marginOf(i);
      if (factor * distance > margin)
        factor = margin / distance;
    }
  }
  return factor;
}

double NodalContacts::freeDistanceTruncation(const State& state, const Motion& motion, double factor,
                                             StepReport& report)
{
  askFreeDistances(state, motion, factor, report);
  for (int j = query_.first_node; j + 1 < rod_.nodes(); ++j)
  {
    const auto e = static_cast<std::size_t>(j - free_distances_.first_edge);
    const bool known = !free_distances_.stale && e < free_distances_.free_distance.size();
    // Less than the margin there says nothing: what is within is listed, if it was asked with the same one.
    const auto q = static_cast<std::size_t>(j - query_.first_node);
    const double told = known ? free_distances_.free_distance[e] : 0.0;
    const double free = told > std::min(query_.marginAt(q), query_.marginAt(q + 1)) ? told : 0.0;
    const double first = motion[j].norm();
    const double second = motion[j + 1].norm();
    if (factor * first <= marginOf(j) && factor * second <= marginOf(j + 1))
      continue;
    // Either both nodes stay within their margins or both within what is free.
    const double margins = std::min(marginOf(j) / first, marginOf(j + 1) / second);
    factor = std::min(factor, std::max(margins, free / std::max(first, second)));
  }
  return factor;
}

/** Old features cover only the margin around the state they were found at: all motion since then is spent from it. */
double NodalContacts::staleTruncation(const Motion& motion)
{
  const double most = marginsIn(motion, query_.first_node);
  const double factor = most > stale_budget_ ? stale_budget_ / most : 1.0;
  stale_budget_ -= factor * most;
  return factor;
}

void NodalContacts::updateWallForces(State& state, const Motion& motion)
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

void NodalContacts::detectAgain(const State& state, StepReport& report)
{
  ask(state, contacts_, report);
  if (contacts_.stale)
    stale_budget_ = 0.0;  // it is not known any more where this set was found
  else
    addBacking();
}

void NodalContacts::detect(const State& state, StepReport& report)
{
  std::swap(contacts_, previous_contacts_);
  std::swap(springs_, previous_springs_);
  kept_before_ = kept_;
  kept_ = 0;
  ask(state, contacts_, report);
  valid_ = moved_on_ = true;
  if (!contacts_.stale)
  {
    stale_budget_ = 1.0;
    addBacking();
    return;
  }
  contacts_.features = previous_contacts_.features;
  contacts_.features.resize(contacts_.features.size() - kept_before_);
  dropBacking();
  for (contact::Feature& feature : contacts_.features)
    feature.gap = gapAt(state, feature);
  addBacking();
}

/** Of a feature that was found at another state, whose wall is taken as a plane [m]. */
double NodalContacts::gapAt(const State& state, const contact::Feature& feature) const
{
  const double t = feature.parameter;
  const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
  const Eigen::Vector3d axis = (1.0 - t) * state.position[feature.edge] + t * state.position[next];
  const double radius = (1.0 - t) * radiusOf(feature.edge) + t * radiusOf(next);
  return feature.normal.dot(axis - feature.point) - radius;
}

/** Shift of a feature's gap that a change of the sampling left [m]. */
double NodalContacts::offsetAt(const State& state, const contact::Feature& feature) const
{
  const int next = std::min(feature.edge + 1, rod_.nodes() - 1);
  return (1.0 - feature.parameter) * state.wall_offset[feature.edge] + feature.parameter * state.wall_offset[next];
}

void NodalContacts::keepPressed(const State& state)
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

void NodalContacts::dropKept()
{
  contacts_.features.resize(contacts_.features.size() - kept_);
  kept_ = 0;
}

void NodalContacts::ask(const State& state, contact::ContactSet& answer, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  query_.wanted_free_distance = 0.0;
  const HeldWire held(rod_, boundary_);
  held.describe(state, query_);
  widen();
  const double mouth = held.describeMouth(state, query_);
  query_.wide_margin = wantedWideMargin();
  send(answer, report);
  if (answer.stale)
    return;
  keepMargins();
  // The first point stood inside of its edge.
  for (contact::Feature& feature : answer.features)
    if (feature.edge == query_.first_node)
      feature.parameter = mouth + (1.0 - mouth) * feature.parameter;
}

/** From the first edge on that moves further than the margin, whose features are known. */
void NodalContacts::askFreeDistances(const State& state, const Motion& motion, double factor, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  const HeldWire held(rod_, boundary_);
  held.describe(state, query_);
  widen();
  held.describeMouth(state, query_);
  double farthest = 0.0;
  int first = rod_.nodes() - 1;
  for (int i = query_.first_node; i < rod_.nodes(); ++i)
  {
    const double far = factor * motion[i].norm();
    farthest = std::max(farthest, far);
    if (far > kBeyondMargin * marginOf(i))
      first = std::min(first, i - 1);
  }
  const int skipped = std::max(0, first - query_.first_node);
  query_.first_node += skipped;
  query_.nodes.erase(query_.nodes.begin(), query_.nodes.begin() + skipped);
  query_.radius.erase(query_.radius.begin(), query_.radius.begin() + skipped);
  query_.wanted_free_distance = farthest;
  send(free_distances_, report);
}

void NodalContacts::send(contact::ContactSet& answer, StepReport& report)
{
  query_.step = step_;
  query_.substep = substep_;
  query_.pass = *pass_;
  query_.margin = settings_.contact_margin;
  query_.vessel_version = vessel_version_;
  // Once an answer has failed to come, the rest of the step makes do without: a replay then needs one number only.
  answer.stale = step_is_stale_;
  if (!step_is_stale_)
    source_->detect(query_, answer);
  if (answer.stale && !step_is_stale_)
    report.first_stale_pass = *pass_;
  step_is_stale_ = answer.stale;
  ++*pass_;
}

bool NodalContacts::foundUnknown(const State& state) const
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
