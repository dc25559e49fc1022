#pragma once

#include "contact/wall_features.h"

namespace endovascular_sim::contact
{

/** Features of a wall of facets: local minima of the distance between the axis and triangles, reflex edges and
 *  vertices. */
class FacetFeatures : public WallFeatures
{
public:
  void find(const WallModel& model, const WireLists& lists, const Query& query,
            std::vector<Feature>& features) override;
  double distanceToListed(const WallModel& model, const NeighbourList& list, const Eigen::Vector3d& point,
                          double cutoff) const override;
};

}  // namespace endovascular_sim::contact
