#include "rviz_plugin/model/branch_finder.h"

#include <limits>

#include "rviz_plugin/model/message_points.h"
#include "visualization/wall_surface.h"

namespace endovascular_sim::rviz_plugin
{

BranchFinder::BranchFinder(const VesselCentreline& centreline)
{
  for (const VesselCentrelineBranch& branch : centreline.branches)
  {
    for (const geometry_msgs::Point& point : branch.points)
      if (toEigen(point).allFinite())
        places_.push_back({toEigen(point), labels_.size()});
    labels_.push_back(visualization::branchLabel(branch.name));
  }
}

std::string BranchFinder::branchAt(const Eigen::Vector3d& point) const
{
  double nearest = std::numeric_limits<double>::infinity();
  const std::string* label = nullptr;
  for (const Place& place : places_)
  {
    const double distance = (place.point - point).squaredNorm();
    if (distance < nearest)
    {
      nearest = distance;
      label = &labels_[place.branch];
    }
  }
  return label == nullptr ? std::string() : *label;
}

}  // namespace endovascular_sim::rviz_plugin
