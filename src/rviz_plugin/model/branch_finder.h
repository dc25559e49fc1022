#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "endovascular_sim/VesselCentreline.h"

namespace endovascular_sim::rviz_plugin
{

/** Finds the branch that contains a point. */
class BranchFinder
{
public:
  BranchFinder() = default;
  /** Invalid points are ignored. */
  explicit BranchFinder(const VesselCentreline& centreline);

  /** Name of the branch with the nearest point of the centreline; empty without one, or for an invalid point. */
  std::string branchAt(const Eigen::Vector3d& point) const;

private:
  struct Place
  {
    Eigen::Vector3d point;
    std::size_t branch;
  };
  std::vector<Place> places_;
  std::vector<std::string> labels_;
};

}  // namespace endovascular_sim::rviz_plugin
