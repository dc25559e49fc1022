#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::rod
{

/** Wall: a plane through the origin; every node near it has a contact. */
class PlaneWall : public contact::ContactSource
{
public:
  explicit PlaneWall(double friction, const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ())
    : friction_(friction), normal_(normal)
  {
  }

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    if (query.wanted_free_distance <= 0.0)
    {
      wide_margin = query.wide_margin;
      margins.clear();
      for (std::size_t i = 0; i < query.nodes.size(); ++i)
        margins.push_back(query.marginAt(i));
    }
    set.features.clear();
    set.first_edge = query.first_node;
    set.free_distance.clear();
    const int n = static_cast<int>(query.nodes.size());
    for (int i = 0; i < n; ++i)
    {
      const double gap = normal_.dot(query.nodes[i]) - query.radius[i];
      if (i + 1 < n)
        set.free_distance.push_back(
            std::max(0.0, std::min(gap, normal_.dot(query.nodes[i + 1]) - query.radius[i + 1])));
      if (gap > query.marginAt(static_cast<std::size_t>(i)))
        continue;
      contact::Feature feature;
      feature.edge = query.first_node + std::min(i, n - 2);
      feature.parameter = i == n - 1 ? 1.0 : 0.0;
      feature.point = query.nodes[i] - normal_.dot(query.nodes[i]) * normal_;
      feature.normal = normal_;
      feature.gap = gap;
      feature.friction = friction_;
      feature.stiffness = stiffness;
      feature.id = 3 * i;
      set.features.push_back(feature);
    }
    set.stale = stale;
  }

  double stiffness = std::numeric_limits<double>::infinity();    ///< [N/m²]
  double wide_margin = std::numeric_limits<double>::infinity();  ///< that features were last asked for with [m]
  std::vector<double> margins;                                   ///< of the nodes, then [m]
  bool stale = false;                                            ///< what is said of the answers

private:
  double friction_;
  Eigen::Vector3d normal_;
};

}  // namespace endovascular_sim::rod
