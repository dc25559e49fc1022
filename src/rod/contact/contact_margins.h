#pragma once

#include <algorithm>
#include <limits>

#include "contact/contract/contact_set.h"
#include "rod/contact/node_renumbering.h"

namespace endovascular_sim::rod
{

/** Share of the contact margin granted to a body: 1 up to the radius of a thin catheter, (0.9 mm/r)⁴ beyond it, at
 *  least 0.25. The full margin of a filled balloon would contain the whole wall around it. Balloons move little. */
inline double marginShare(double radius)
{
  constexpr double kLeast = 0.25;   // exceeds the travel and the growth of a balloon per sub-step
  constexpr double kWide = 0.9e-3;  // m
  if (radius <= kWide)
    return 1.0;
  const double share = kWide / radius;
  return std::max(kLeast, share * share * share * share);
}

/** True for wide bodies, those with less than half of the margin: their margin is bounded by their recent motion. */
inline bool isWide(double radius)
{
  return marginShare(radius) < 0.5;
}

/** Rule for the margin of each node of a query. */
struct MarginRule
{
  double margin = 0.0;                                             ///< margin of a slender body [m]
  double widest_margin = std::numeric_limits<double>::infinity();  ///< upper bound for wide bodies [m]
  double snap_margin = 0.0;  ///< replaces the margin in a snap-through, if larger [m]
  NodeRange snap;            ///< nodes in a snap-through; wide ones among them keep their margin

  /** Margin at a node [m]. */
  double at(int node, double radius) const
  {
    const bool wide = isWide(radius);
    const double base = snap.contains(node) && !wide ? std::max(margin, snap_margin) : margin;
    const double own = base * marginShare(radius);
    return wide ? std::min(own, widest_margin) : own;
  }

  /** Sets the margin of every node of a query from its radius. */
  void apply(contact::Query& query) const
  {
    query.margin.resize(query.nodes.size());
    for (std::size_t i = 0; i < query.nodes.size(); ++i)
      query.margin[i] = at(query.first_node + static_cast<int>(i), query.radius[i]);
  }
};

/** Rule without wide bodies' bound and without a snap-through. @param margin of a slender body [m] */
inline MarginRule uniformMargin(double margin)
{
  MarginRule rule;
  rule.margin = margin;
  return rule;
}

}  // namespace endovascular_sim::rod
