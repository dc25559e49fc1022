#pragma once

#include <algorithm>
#include <limits>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::rod
{

/** Wall: a tube about the x axis with the wire inside; every node has a contact at the nearest point. */
class TroughWall : public contact::ContactSource
{
public:
  TroughWall(double radius, double friction) : friction(friction), radius_(radius) {}

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    set.features.clear();
    set.first_edge = query.first_node;
    const int n = static_cast<int>(query.nodes.size());
    set.free_distance.assign(static_cast<std::size_t>(n - 1), 0.0);
    for (int i = 0; i < n; ++i)
    {
      const Eigen::Vector3d across(0.0, query.nodes[i].y(), query.nodes[i].z());
      const double gap = radius_ - across.norm() - query.radius[i];
      if (gap > query.margin[i] || across.isZero(0.0))
        continue;
      contact::Feature feature;
      feature.edge = query.first_node + std::min(i, n - 2);
      feature.parameter = i == n - 1 ? 1.0 : 0.0;
      feature.normal = -across.normalized();
      feature.point = query.nodes[i] - across - radius_ * feature.normal;
      feature.gap = gap;
      feature.clearance_radius = radius_ - query.radius[i];
      feature.friction = friction;
      feature.id = 3 * i;
      set.features.push_back(feature);
    }
    set.stale = false;
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override { detect(query, set); }

  double friction;

private:
  double radius_;
};

}  // namespace endovascular_sim::rod
