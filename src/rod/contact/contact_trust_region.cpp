#include <algorithm>
#include <cmath>
#include <limits>

#include "rod/boundary/boundary_conditions.h"
#include "rod/contact/contact_solver_state.h"

// How far a solve may move the wire: margins within which every feature is listed, and free distances beyond them.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kWideMargin = 5e-6;           // m of a filled balloon's margin, and
constexpr double kWideMotions = 4.0;           // so many times its last motion
constexpr double kLeastOfMargin = 0.5;         // that growth leaves, so that the wire is not held
constexpr double kBeyondMargin = 1.0 + 1e-12;  // for rounding
constexpr double kFastMotion = 0.6;            // of the margin, in one solve: a node that moves more is fast
constexpr double kFastMargin = 3.0;            // times the margin, for nodes that are
constexpr int kBesideFast = 2;                 // nodes on either side that count too
constexpr double kShareOfClearance = 0.9;      // that a fast node may move

}  // namespace

/** Of a node that is not fast [m]. */
double ContactSolver::usualMargin(int node) const
{
  return settings_.contact_margin * marginShare(radiusOf(node));
}

/** By which a node's surface may come closer to a wall that was not listed [m]. */
double ContactSolver::listedMargin(int node) const
{
  const auto i = static_cast<std::size_t>(node);
  return i < margins_.size() ? margins_[i] : usualMargin(node);
}

/** The least of some nodes' values at a node and its neighbours. */
double ContactSolver::leastAround(int node, double (ContactSolver::*value)(int) const) const
{
  return std::min({(this->*value)(std::max(0, node - 1)), (this->*value)(node),
                   (this->*value)(std::min(node + 1, rod_.nodes() - 1))});
}

double ContactSolver::marginOf(int node) const
{
  const auto i = static_cast<std::size_t>(node);
  return i < reaches_.size() ? reaches_[i] : leastAround(node, &ContactSolver::usualMargin);
}

void NodeRange::add(const NodeRange& other)
{
  if (other.empty())
    return;
  begin = empty() ? other.begin : std::min(begin, other.begin);
  end = std::max(end, other.end);
}

/** From the first to the last one that a solve wants to move by much of the margin. */
void ContactSolver::noteFastNodes(const Motion& motion, int first)
{
  const double fast = kFastMotion * settings_.contact_margin;
  for (int i = first; i < rod_.nodes(); ++i)
    if (motion[i].squaredNorm() > fast * fast)
      fast_.add({std::max(0, i - kBesideFast), std::min(i + kBesideFast + 1, rod_.nodes())});
}

/** A snap takes the wire farther than the margin in one step: where it is under way it is asked about farther off, so
 *  that fewer solves have to be cut short. */
void ContactSolver::widenQueryForSnaps()
{
  margin_rule_.snap = fast_before_;
  margin_rule_.snap.add(fast_);
  margin_rule_.snap_margin = margin_rule_.snap.empty() ? 0.0 : kFastMargin * settings_.contact_margin;
}

/** How far the axis of every node's edges is at least from the wall: the distance from an edge's surface to the wall is
 *  least at a contact or at a node, and the axis lies by the edge's least radius deeper in the lumen [m]. */
void ContactSolver::findClearances()
{
  clearances_.clear();
  for (int i = 0; i < rod_.nodes(); ++i)
    clearances_.push_back(leastAround(i, &ContactSolver::radiusOf) + leastAround(i, &ContactSolver::listedMargin));
  for (const contact::Feature& feature : contacts_.features)
  {
    const int first = std::max(0, feature.edge - (feature.parameter <= 0.0 ? 1 : 0));
    const int last = std::min(rod_.nodes() - 2, feature.edge + (feature.parameter >= 1.0 ? 1 : 0));
    for (int edge = first; edge <= last; ++edge)
    {
      const double clearance = std::max(0.0, feature.gap + std::min(rod_.radius[edge], rod_.radius[edge + 1]));
      clearances_[edge] = std::min(clearances_[edge], clearance);
      clearances_[edge + 1] = std::min(clearances_[edge + 1], clearance);
    }
  }
}

/** None of a node's edges' points meets what the detector did not list; nor, where that is far off, comes so far that
 *  the axis could reach any wall at all. */
void ContactSolver::keepReaches()
{
  const bool far = margin_rule_.snap_margin > 0.0;
  if (far)
    findClearances();
  reaches_.resize(static_cast<std::size_t>(rod_.nodes()));
  any_wide_ = false;
  for (int i = 0; i < rod_.nodes(); ++i)
  {
    reaches_[i] = leastAround(i, &ContactSolver::listedMargin);
    if (far)
      reaches_[i] = std::min(reaches_[i],
                             std::max(leastAround(i, &ContactSolver::usualMargin), kShareOfClearance * clearances_[i]));
    any_wide_ = any_wide_ || isWide(radiusOf(i));
  }
}

/** Of what has just been asked. */
void ContactSolver::keepMargins()
{
  margins_.clear();
  for (int i = 0; i < query_.first_node; ++i)
    margins_.push_back(usualMargin(i));
  for (std::size_t i = 0; i < query_.nodes.size(); ++i)
    margins_.push_back(query_.margin[i]);
}

/** What grows comes closer to walls that were not listed. */
void ContactSolver::spendMargins(const std::vector<double>& radii)
{
  for (std::size_t i = 0; i < margins_.size(); ++i)
  {
    const double growth = std::max(0.0, growthTo(radii[i], static_cast<int>(i)));
    margins_[i] = std::max(kLeastOfMargin * margins_[i], margins_[i] - growth);
    if (isWide(radii[i]))
      wide_motion_ = std::max(wide_motion_, growth);
    any_wide_ = any_wide_ || isWide(radii[i]);
  }
  for (std::size_t i = 0; i < reaches_.size(); ++i)
    reaches_[i] = std::min(reaches_[i], leastAround(static_cast<int>(i), &ContactSolver::listedMargin));
}

/** The node or a neighbour. */
bool ContactSolver::isWideAt(int node) const
{
  return isWide(
      std::max({radiusOf(std::max(0, node - 1)), radiusOf(node), radiusOf(std::min(node + 1, rod_.nodes() - 1))}));
}

/** Notes the motion of the wide body that moves most. */
void ContactSolver::noteWideMotion(const Motion& motion, int first, double factor)
{
  double most = 0.0;
  for (int i = first; i < rod_.nodes() && any_wide_; ++i)
    if (isWideAt(i))
      most = std::max(most, factor * motion[i].norm());
  wide_motion_ = std::isinf(wide_motion_) ? most : std::max(most, wide_motion_);
}

/** A filled balloon has the whole wall round it and hardly moves: it is asked about as far as it may soon move. */
double ContactSolver::wantedWideMargin() const
{
  bool filled = false;
  for (std::size_t i = 0; i < radii_.size() && !filled; ++i)
    filled = isWide(radii_[i]) && radii_[i] > rod_.radius[i];
  return filled ? kWideMargin + kWideMotions * wide_motion_ : std::numeric_limits<double>::infinity();
}

double ContactSolver::truncation(const State& state, const Motion& motion, double factor, StepReport& report)
{
  if (!source_)
    return factor;
  if (contacts_.stale)
    return std::min(factor, staleTruncation(motion));
  noteFastNodes(motion, state.first_node);
  const double margins = marginsIn(motion, state.first_node);
  factor = freshTruncation(state, motion, factor, margins, report);
  noteWideMotion(motion, state.first_node, factor);
  // Should the next set fail to come, this motion counts as well.
  stale_motion_budget_ = std::max(0.0, 1.0 - factor * margins);
  return factor;
}

/** @param margins that the whole motion goes by at most */
double ContactSolver::freshTruncation(const State& state, const Motion& motion, double factor, double margins,
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
double ContactSolver::marginsIn(const Motion& motion, int first) const
{
  double most = 0.0;  // squared, until all are seen
  for (int i = first; i < rod_.nodes(); ++i)
  {
    const double margin = marginOf(i);
    if (motion[i].squaredNorm() > most * margin * margin)
      most = motion[i].squaredNorm() / (margin * margin);
  }
  return std::sqrt(most);
}

/** Where a contact is listed the free distance is the margin, and it need not be asked for: mostly that settles it. */
double ContactSolver::listedTruncation(const State& state, const Motion& motion, double factor) const
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

double ContactSolver::freeDistanceTruncation(const State& state, const Motion& motion, double factor,
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
    const double free = told > std::min(query_.margin[q], query_.margin[q + 1]) ? told : 0.0;
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
double ContactSolver::staleTruncation(const Motion& motion)
{
  const double most = marginsIn(motion, query_.first_node);
  const double factor = most > stale_motion_budget_ ? stale_motion_budget_ / most : 1.0;
  stale_motion_budget_ -= factor * most;
  return factor;
}

/** From the first edge on that moves further than the margin, whose features are known. */
void ContactSolver::askFreeDistances(const State& state, const Motion& motion, double factor, StepReport& report)
{
  PhaseTimer::Scope scope(*timer_, Phase::kCollision);
  const BoundaryConditions held(rod_, boundary_);
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
  send(farthest, free_distances_, report);
}

}  // namespace endovascular_sim::rod
