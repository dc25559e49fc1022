#pragma once

#include <algorithm>
#include <vector>

#include "contact/contract/contact_set.h"
#include "rod/contact/contact_margins.h"
#include "rod/contact/node_renumbering.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Surface of the wire with its balloons: at each node the larger one of the wire's radius and a least radius. */
class WireSurface
{
public:
  /** @param rod must outlive the surface */
  explicit WireSurface(const Discretisation& rod) : rod_(rod) {}

  int nodes() const { return rod_.nodes(); }

  /** Radius at a node [m]. */
  double radius(int node) const
  {
    return least_radius_.empty() ? rod_.radius[node] : std::max(rod_.radius[node], least_radius_[node]);
  }

  /** Increase of a node's radius if its least radius becomes @p least_radius [m]. */
  double growthTo(double least_radius, int node) const
  {
    return std::max(rod_.radius[node], least_radius) - radius(node);
  }

  /** Least radius per node; empty: the wire's own radius everywhere [m]. */
  const std::vector<double>& leastRadius() const { return least_radius_; }
  void setLeastRadius(const std::vector<double>& least_radius) { least_radius_ = least_radius; }

  /** True where a wide balloon is filled beyond the wire's radius. */
  bool hasWideBalloon() const;

  /** True where a node or a neighbour is wide. */
  bool isWideAround(int node) const;

  /** Gap between the surface and the plane of a feature [m]. */
  double gapTo(const contact::Feature& feature, const State& state) const;

  void resample(const NodeRenumbering& renumbering) { renumbering.apply(least_radius_); }
  void archive(Archive& archive);

private:
  const Discretisation& rod_;
  std::vector<double> least_radius_;
};

}  // namespace endovascular_sim::rod
