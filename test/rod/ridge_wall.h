#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::rod
{

/** Wall: a compliant roof z = −slope·|x − ridge|. Nodes contact its faces, an edge of the wire its ridge. */
class RidgeWall : public contact::ContactSource
{
public:
  /** @param stiffness per length of wire [N/m²] */
  RidgeWall(double ridge, double slope, double stiffness) : ridge_(ridge), slope_(slope), stiffness_(stiffness) {}

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    set.features.clear();
    set.first_edge = query.first_node;
    set.free_distance.assign(query.nodes.size() - 1, 0.0);
    set.stale = false;
    const int n = static_cast<int>(query.nodes.size());
    for (int i = 0; i < n; ++i)
      add(query, std::min(i, n - 2), i == n - 1 ? 1.0 : 0.0, set);
    for (int i = 0; i + 1 < n; ++i)
    {
      const double t = (ridge_ - query.nodes[i].x()) / (query.nodes[i + 1].x() - query.nodes[i].x());
      if (t > 1e-9 && t < 1.0 - 1e-9)
        add(query, i, t, set);
    }
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override { detect(query, set); }

private:
  void add(const contact::Query& query, int edge, double t, contact::ContactSet& set) const
  {
    const auto e = static_cast<std::size_t>(edge);
    const Eigen::Vector3d on_edge = (1.0 - t) * query.nodes[e] + t * query.nodes[e + 1];
    const double along = on_edge.x() - ridge_;
    contact::Feature feature;
    feature.edge = query.first_node + edge;
    feature.parameter = t;
    feature.normal = Eigen::Vector3d(along == 0.0 ? 0.0 : std::copysign(slope_, along), 0.0, 1.0).normalized();
    feature.gap = (on_edge.z() + slope_ * std::abs(along)) * feature.normal.z() - query.radius[e];
    feature.point = on_edge - (feature.gap + query.radius[e]) * feature.normal;
    feature.stiffness = stiffness_;
    feature.id = 3 * edge + (t > 0.0 && t < 1.0 ? 1 : 0);
    if (feature.gap < query.margin[e])
      set.features.push_back(feature);
  }

  double ridge_, slope_, stiffness_;
};

}  // namespace endovascular_sim::rod
