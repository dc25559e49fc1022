#pragma once

#include <vector>

#include "contact/narrow_phase/smooth_foot.h"
#include "contact/wall_features.h"

namespace endovascular_sim::contact
{

/** Features of a smooth wall: feet of the nodes, and minima of the distance between them. */
class SmoothFeatures : public WallFeatures
{
public:
  void find(const WallModel& model, const WireLists& lists, const Query& query,
            std::vector<Feature>& features) override;
  double distanceToListed(const WallModel& model, const NeighbourList& list, const Eigen::Vector3d& point,
                          double cutoff) const override;

private:
  void findFeet(const WallModel& model, const NeighbourList& list, const Eigen::Vector3d& point, double cutoff);
  void addNodeFeatures(const Query& query, std::size_t node, std::vector<Feature>& features);

  std::vector<SmoothFoot> nearest_;  ///< per node: nearest foot within the cutoff; triangle −1 without
  std::vector<SmoothFoot> feet_;     ///< of the present node
};

}  // namespace endovascular_sim::contact
