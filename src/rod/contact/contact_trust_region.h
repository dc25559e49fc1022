#pragma once

#include <vector>

#include "contact/contract/contact_set.h"
#include "rod/contact/contact_query.h"
#include "rod/contact/node_renumbering.h"
#include "rod/contact/wire_surface.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Trust region of a solve: the motion of every node within which all features that it may touch are listed.
 *
 *  A node may move by its reach, the least margin of itself and its neighbours. Farther motions are truncated, unless
 *  queried free distances permit them. On a stale contact set, all motions together may use the reach once. */
class ContactTrustRegion
{
public:
  /** @param rod, settings, surface, query must outlive this */
  ContactTrustRegion(const Discretisation& rod, const StepperSettings& settings, const WireSurface& surface,
                     ContactQueryBuilder& query)
    : rod_(rod), settings_(settings), surface_(surface), query_(query)
  {
  }

  /** Largest motion of a node for which the features within its reach are among the present contacts [m]. */
  double reach(int node) const
  {
    const auto i = static_cast<std::size_t>(node);
    return i < reach_.size() ? reach_[i] : leastAround(node, [this](int k) { return usualMargin(k); });
  }

  /** Sets the reach of every node from the query just answered. */
  void update(const std::vector<contact::Feature>& features);

  /** Subtracts the growth of a balloon from the margins, before the surface gets the new radii; at least half of each
   *  margin is left, so that the wire is not held in position. @param least_radius per node [m] */
  void subtractGrowth(const std::vector<double>& least_radius);

  /** Sets the share of every node's reach that may be used if the next contact set is stale. */
  void setStaleBudget(double share) { stale_motion_budget_ = share; }

  /** Share of a motion, at most @p factor, within the trust region.
   *  @param contacts present contact set */
  double truncation(const State& state, const NodalMotion& motion, double factor, const contact::ContactSet& contacts,
                    StepReport& report);

  void resample(const NodeRenumbering& renumbering);
  void archive(Archive& archive);

private:
  template <typename Value>
  double leastAround(int node, const Value& value) const;
  double usualMargin(int node) const { return settings_.contact_margin * marginShare(surface_.radius(node)); }
  double listedMargin(int node) const
  {
    const auto i = static_cast<std::size_t>(node);
    return i < margins_.size() ? margins_[i] : usualMargin(node);
  }
  void storeMargins();
  void findAxisClearances(const std::vector<contact::Feature>& features);
  double motionInReaches(const NodalMotion& motion, int first) const;
  double wideMotion(const NodalMotion& motion, int first, double factor) const;
  double freshTruncation(const State& state, const NodalMotion& motion, double factor, double reaches,
                         const contact::ContactSet& contacts, StepReport& report);
  double listedTruncation(const State& state, const NodalMotion& motion, double factor,
                          const contact::ContactSet& contacts) const;
  double freeDistanceTruncation(const State& state, const NodalMotion& motion, double factor, StepReport& report);
  void queryFreeDistances(const State& state, const NodalMotion& motion, double factor, StepReport& report);
  double staleTruncation(const NodalMotion& motion);

  const Discretisation& rod_;
  const StepperSettings& settings_;
  const WireSurface& surface_;
  ContactQueryBuilder& query_;
  contact::ContactSet free_distances_;
  std::vector<double> margins_;          ///< margin of every node in the last fresh set, less its growth since then [m]
  std::vector<double> reach_;            ///< [m]
  std::vector<double> axis_clearances_;  ///< distance of every node's edges' axes from the wall, at least [m]
  bool any_wide_ = false;                ///< the wire has a wide body
  double stale_motion_budget_ = 0.0;     ///< share of every node's reach
};

/** Least value of a function at a node and its neighbours. */
template <typename Value>
double ContactTrustRegion::leastAround(int node, const Value& value) const
{
  return std::min({value(std::max(0, node - 1)), value(node), value(std::min(node + 1, rod_.nodes() - 1))});
}

}  // namespace endovascular_sim::rod
