#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::rod
{

/** Wall: a cylinder about the z axis with the wire outside; every node near it has a contact. */
class CylinderWall : public contact::ContactSource
{
public:
  CylinderWall(double radius, double friction) : radius_(radius), friction_(friction) {}

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    set.features.clear();
    set.first_edge = query.first_node;
    set.free_distance.clear();
    const int n = static_cast<int>(query.nodes.size());
    for (int i = 0; i < n; ++i)
    {
      const Eigen::Vector3d across(query.nodes[i].x(), query.nodes[i].y(), 0.0);
      const double gap = across.norm() - radius_ - query.radius[i];
      if (i + 1 < n)
        set.free_distance.push_back(std::max(0.0, 0.5 * gap));
      if (gap > query.margin[i])
        continue;
      contact::Feature feature;
      feature.edge = query.first_node + std::min(i, n - 2);
      feature.parameter = i == n - 1 ? 1.0 : 0.0;
      feature.normal = across.normalized();
      feature.point = query.nodes[i] - across + radius_ * feature.normal;
      feature.gap = gap;
      feature.friction = friction_;
      feature.id = 3 * i;
      set.features.push_back(feature);
    }
    set.stale = false;
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override { detect(query, set); }

private:
  double radius_;
  double friction_;
};

}  // namespace endovascular_sim::rod
