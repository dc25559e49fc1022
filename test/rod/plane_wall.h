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
    margins = query.margin;
    freeDistances(query, 0.0, set);
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override
  {
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
      if (gap > query.margin[static_cast<std::size_t>(i)])
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

  double stiffness = std::numeric_limits<double>::infinity();  ///< [N/m²]
  std::vector<double> margins;                                 ///< margins of the last query for features [m]
  bool stale = false;                                          ///< mark of every answer

private:
  double friction_;
  Eigen::Vector3d normal_;
};

}  // namespace endovascular_sim::rod
