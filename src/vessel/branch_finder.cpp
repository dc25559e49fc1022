#include "vessel/branch_finder.h"

#include <algorithm>
#include <limits>

namespace endovascular_sim::vessel
{
namespace
{

/** Distance from a point to the lumen along one segment of a branch, negative inside [m]. */
double distanceToLumen(const Eigen::Vector3d& point, const CentrelineBranch& branch, std::size_t k)
{
  const std::size_t next = std::min(k + 1, branch.points.size() - 1);
  const Eigen::Vector3d segment = branch.points[next] - branch.points[k];
  const double length2 = segment.squaredNorm();
  const double along = length2 > 0.0 ? segment.dot(point - branch.points[k]) / length2 : 0.0;
  const double share = std::clamp(along, 0.0, 1.0);
  const double radius = branch.radii[k] + share * (branch.radii[next] - branch.radii[k]);
  return (point - branch.points[k] - share * segment).norm() - radius;
}

}  // namespace

BranchFinder::BranchFinder(const CentrelineTree& tree) : branches_(tree.branches), bounds_(tree.branches.size())
{
  for (std::size_t b = 0; b < branches_.size(); ++b)
  {
    for (const Eigen::Vector3d& point : branches_[b].points)
      bounds_[b].box.extend(point);
    for (const double radius : branches_[b].radii)
      bounds_[b].widest = std::max(bounds_[b].widest, radius);
  }
}

int BranchFinder::nearest(const Eigen::Vector3d& point) const
{
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < branches_.size(); ++b)
  {
    const CentrelineBranch& branch = branches_[b];
    if (branch.points.empty() || bounds_[b].box.exteriorDistance(point) - bounds_[b].widest >= least)
      continue;
    for (std::size_t k = 0; k + 1 < std::max<std::size_t>(branch.points.size(), 2); ++k)
    {
      const double distance = distanceToLumen(point, branch, k);
      if (distance >= least)
        continue;
      least = distance;
      nearest = static_cast<int>(b);
    }
  }
  return nearest;
}

}  // namespace endovascular_sim::vessel
