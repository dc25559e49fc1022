#include "rod/contact/contact_trust_region.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLeastOfMargin = 0.5;        // share of a margin that growth leaves
constexpr double kBeyondReach = 1.0 + 1e-12;  // tolerance for rounding
constexpr double kShareOfClearance = 0.9;     // of the axis' distance from the wall, per solve

}  // namespace

void ContactTrustRegion::storeMargins()
{
  const contact::Query& query = query_.query();
  margins_.clear();
  for (int i = 0; i < query.first_node; ++i)
    margins_.push_back(usualMargin(i));
  margins_.insert(margins_.end(), query.margin.begin(), query.margin.end());
}

/** Lower bounds: the distance between an edge's surface and the wall is least at a contact or at a node, and the axis
 *  lies deeper in the lumen by the edge's least radius. */
void ContactTrustRegion::findAxisClearances(const std::vector<contact::Feature>& features)
{
  axis_clearances_.clear();
  for (int i = 0; i < rod_.nodes(); ++i)
    axis_clearances_.push_back(leastAround(i, [this](int k) { return surface_.radius(k); }) +
                               leastAround(i, [this](int k) { return listedMargin(k); }));
  for (const contact::Feature& feature : features)
  {
    const int first = std::max(0, feature.edge - (feature.parameter <= 0.0 ? 1 : 0));
    const int last = std::min(rod_.nodes() - 2, feature.edge + (feature.parameter >= 1.0 ? 1 : 0));
    for (int edge = first; edge <= last; ++edge)
    {
      const double clearance = std::max(0.0, feature.gap + std::min(rod_.radius[edge], rod_.radius[edge + 1]));
      axis_clearances_[edge] = std::min(axis_clearances_[edge], clearance);
      axis_clearances_[edge + 1] = std::min(axis_clearances_[edge + 1], clearance);
    }
  }
}

/** In a snap-through the margin exceeds the wire's radius. There, a node's motion is bounded by 0.9 of the axis'
 *  distance from the wall too, so that the axis cannot cross a wall. */
void ContactTrustRegion::update(const std::vector<contact::Feature>& features)
{
  storeMargins();
  const bool snap = query_.marginRule().snap_margin > 0.0;
  if (snap)
    findAxisClearances(features);
  reach_.resize(static_cast<std::size_t>(rod_.nodes()));
  any_wide_ = false;
  for (int i = 0; i < rod_.nodes(); ++i)
  {
    reach_[i] = leastAround(i, [this](int k) { return listedMargin(k); });
    if (snap)
      reach_[i] = std::min(reach_[i], std::max(leastAround(i, [this](int k) { return usualMargin(k); }),
                                               kShareOfClearance * axis_clearances_[i]));
    any_wide_ = any_wide_ || isWide(surface_.radius(i));
  }
}

void ContactTrustRegion::subtractGrowth(const std::vector<double>& least_radius)
{
  bool grows = false;
  for (std::size_t i = 0; i < margins_.size(); ++i)
  {
    const double growth = std::max(0.0, surface_.growthTo(least_radius[i], static_cast<int>(i)));
    grows = grows || growth > 0.0;
    margins_[i] = std::max(kLeastOfMargin * margins_[i], margins_[i] - growth);
    if (isWide(least_radius[i]))
      query_.noteWideGrowth(growth);
    any_wide_ = any_wide_ || isWide(least_radius[i]);
  }
  for (std::size_t i = 0; grows && i < reach_.size(); ++i)
    reach_[i] = std::min(reach_[i], leastAround(static_cast<int>(i), [this](int k) { return listedMargin(k); }));
}

double ContactTrustRegion::truncation(const State& state, const NodalMotion& motion, double factor,
                                      const contact::ContactSet& contacts, StepReport& report)
{
  if (contacts.stale)
    return std::min(factor, staleTruncation(motion));
  query_.noteSnapThrough(motion, state.first_node);
  const double reaches = motionInReaches(motion, state.first_node);
  factor = freshTruncation(state, motion, factor, reaches, contacts, report);
  query_.noteWideMotion(wideMotion(motion, state.first_node, factor));
  // If the next contact set is stale, this motion counts as well.
  stale_motion_budget_ = std::max(0.0, 1.0 - factor * reaches);
  return factor;
}

/** Largest motion of the wide bodies and their neighbours [m]. */
double ContactTrustRegion::wideMotion(const NodalMotion& motion, int first, double factor) const
{
  double largest = 0.0;
  for (int i = first; i < rod_.nodes() && any_wide_; ++i)
    if (surface_.isWideAround(i))
      largest = std::max(largest, factor * motion[i].norm());
  return largest;
}

/** Largest motion of a node in units of its reach. */
double ContactTrustRegion::motionInReaches(const NodalMotion& motion, int first) const
{
  double largest = 0.0;  // squared inside the loop
  for (int i = first; i < rod_.nodes(); ++i)
  {
    const double own = reach(i);
    if (motion[i].squaredNorm() > largest * own * own)
      largest = motion[i].squaredNorm() / (own * own);
  }
  return std::sqrt(largest);
}

/** @param reaches the whole motion in units of the reach */
double ContactTrustRegion::freshTruncation(const State& state, const NodalMotion& motion, double factor, double reaches,
                                           const contact::ContactSet& contacts, StepReport& report)
{
  if (factor * reaches <= 1.0)
    return factor;
  factor = listedTruncation(state, motion, factor, contacts);
  if (factor * reaches <= kBeyondReach)
    return factor;
  return freeDistanceTruncation(state, motion, factor, report);
}

/** Where a contact is listed, the free distance is the margin. Mostly, these nodes decide and no query is needed. */
double ContactTrustRegion::listedTruncation(const State& state, const NodalMotion& motion, double factor,
                                            const contact::ContactSet& contacts) const
{
  for (const contact::Feature& feature : contacts.features)
  {
    const bool at_first = feature.parameter <= 0.0;
    const bool at_second = feature.parameter >= 1.0;
    const int from = std::max(state.first_node, feature.edge - (at_first ? 1 : 0));
    const int to = std::min(rod_.nodes() - 1, feature.edge + (at_second ? 2 : 1));
    for (int i = from; i <= to; ++i)
    {
      const double distance = motion[i].norm();
      const double own = reach(i);
      if (factor * distance > own)
        factor = own / distance;
    }
  }
  return factor;
}

double ContactTrustRegion::freeDistanceTruncation(const State& state, const NodalMotion& motion, double factor,
                                                  StepReport& report)
{
  queryFreeDistances(state, motion, factor, report);
  const contact::Query& query = query_.query();
  for (int j = query.first_node; j + 1 < rod_.nodes(); ++j)
  {
    const auto e = static_cast<std::size_t>(j - free_distances_.first_edge);
    const bool known = !free_distances_.stale && e < free_distances_.free_distance.size();
    // A value within the margin means listed features at the queried margin: no distance is free of them.
    const auto q = static_cast<std::size_t>(j - query.first_node);
    const double answered = known ? free_distances_.free_distance[e] : 0.0;
    const double free = answered > std::min(query.margin[q], query.margin[q + 1]) ? answered : 0.0;
    const double first = motion[j].norm();
    const double second = motion[j + 1].norm();
    if (factor * first <= reach(j) && factor * second <= reach(j + 1))
      continue;
    // Either both nodes stay within their reach, or both within the free distance.
    const double reaches = std::min(reach(j) / first, reach(j + 1) / second);
    factor = std::min(factor, std::max(reaches, free / std::max(first, second)));
  }
  return factor;
}

/** Queries from the first edge on that leaves its reach. */
void ContactTrustRegion::queryFreeDistances(const State& state, const NodalMotion& motion, double factor,
                                            StepReport& report)
{
  double farthest = 0.0;
  int first_edge = rod_.nodes() - 1;
  for (int i = query_.describe(state); i < rod_.nodes(); ++i)
  {
    const double distance = factor * motion[i].norm();
    farthest = std::max(farthest, distance);
    if (distance > kBeyondReach * reach(i))
      first_edge = std::min(first_edge, i - 1);
  }
  query_.freeDistances(first_edge, farthest, free_distances_, report);
}

/** Stale features cover only the reach around the state of their detection. All motions since then use it up. */
double ContactTrustRegion::staleTruncation(const NodalMotion& motion)
{
  const double reaches = motionInReaches(motion, query_.query().first_node);
  const double factor = reaches > stale_motion_budget_ ? stale_motion_budget_ / reaches : 1.0;
  stale_motion_budget_ -= factor * reaches;
  return factor;
}

void ContactTrustRegion::resample(const NodeRenumbering& renumbering)
{
  renumbering.apply(margins_);
  renumbering.apply(reach_);
}

void ContactTrustRegion::archive(Archive& archive)
{
  archive(stale_motion_budget_, margins_, reach_, any_wide_);
  if (!archive.reading())
    return;
  for (const std::vector<double>* of_nodes : {&margins_, &reach_})
  {
    requireLength(of_nodes->empty() ? 0 : static_cast<std::size_t>(rod_.nodes()), *of_nodes);
    requireNumbers(*of_nodes);
  }
  requireNumbers(stale_motion_budget_);
}

}  // namespace endovascular_sim::rod
