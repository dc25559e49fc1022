#include "vessel/centreline/branch_finder.h"

#include <algorithm>
#include <limits>

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kSegments = 12;  // segments per block
constexpr double kRounding = 1e-9;     // rounding tolerance of distances [m]

/** Signed distance from a point to the lumen of one segment, negative inside [m]. */
double distanceToLumen(const Eigen::Vector3d& point, const CentrelineBranch& branch, std::size_t k)
{
  const std::size_t next = std::min(k + 1, branch.points.size() - 1);
  const Eigen::Vector3d segment = branch.points[next] - branch.points[k];
  const double length2 = segment.squaredNorm();
  const double along = length2 > 0.0 ? segment.dot(point - branch.points[k]) / length2 : 0.0;
  const double t = std::clamp(along, 0.0, 1.0);
  const double radius = branch.radii[k] + t * (branch.radii[next] - branch.radii[k]);
  return (point - branch.points[k] - t * segment).norm() - radius;
}

}  // namespace

BranchFinder::BranchFinder(const CentrelineTree& tree) : branches_(tree.branches)
{
  for (std::size_t b = 0; b < branches_.size(); ++b)
  {
    const CentrelineBranch& branch = branches_[b];
    for (std::size_t first = 0; first < branch.points.size(); first += kSegments)
    {
      if (first > 0 && first + 1 == branch.points.size())
        break;  // the last point belongs to the previous block
      Block block;
      block.branch = static_cast<int>(b);
      block.first = first;
      block.last = std::min(first + kSegments, branch.points.size() - 1);
      for (std::size_t k = block.first; k <= block.last; ++k)
      {
        block.box.extend(branch.points[k]);
        block.widest = std::max(block.widest, branch.radii[k]);
      }
      blocks_.push_back(block);
    }
  }
}

double BranchFinder::distanceTo(const Block& block, const Eigen::Vector3d& point) const
{
  const CentrelineBranch& branch = branches_[static_cast<std::size_t>(block.branch)];
  double least = distanceToLumen(point, branch, block.first);
  for (std::size_t k = block.first + 1; k < block.last; ++k)
    least = std::min(least, distanceToLumen(point, branch, k));
  return least;
}

int BranchFinder::nearest(const Eigen::Vector3d& point) const
{
  const Block* candidate = nullptr;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Block& block : blocks_)
    if (const double bound = block.bound(point); bound < lowest)
    {
      candidate = &block;
      lowest = bound;
    }
  if (candidate == nullptr)
    return -1;
  const double upper_bound = distanceTo(*candidate, point);
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const Block& block : blocks_)
  {
    if (block.bound(point) > upper_bound + kRounding)
      continue;
    const double distance = distanceTo(block, point);
    if (!(distance < least))
      continue;
    least = distance;
    nearest = block.branch;
  }
  return nearest;
}

std::string BranchFinder::nameAt(const Eigen::Vector3d& point) const
{
  const int branch = nearest(point);
  return branch < 0 ? "" : branches_[static_cast<std::size_t>(branch)].name;
}

}  // namespace endovascular_sim::vessel
