#include "vessel/centreline/branch_finder.h"

#include <algorithm>
#include <limits>

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kSegments = 12;  // of a piece
constexpr double kRounding = 1e-9;     // m

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

BranchFinder::BranchFinder(const CentrelineTree& tree) : branches_(tree.branches)
{
  for (std::size_t b = 0; b < branches_.size(); ++b)
  {
    const CentrelineBranch& branch = branches_[b];
    for (std::size_t first = 0; first < branch.points.size(); first += kSegments)
    {
      if (first > 0 && first + 1 == branch.points.size())
        break;  // the last point ends the piece before
      Piece piece;
      piece.branch = static_cast<int>(b);
      piece.first = first;
      piece.last = std::min(first + kSegments, branch.points.size() - 1);
      for (std::size_t k = piece.first; k <= piece.last; ++k)
      {
        piece.box.extend(branch.points[k]);
        piece.widest = std::max(piece.widest, branch.radii[k]);
      }
      pieces_.push_back(piece);
    }
  }
}

double BranchFinder::distanceTo(const Piece& piece, const Eigen::Vector3d& point) const
{
  const CentrelineBranch& branch = branches_[static_cast<std::size_t>(piece.branch)];
  double least = distanceToLumen(point, branch, piece.first);
  for (std::size_t k = piece.first + 1; k < piece.last; ++k)
    least = std::min(least, distanceToLumen(point, branch, k));
  return least;
}

int BranchFinder::nearest(const Eigen::Vector3d& point) const
{
  const Piece* likely = nullptr;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_)
    if (const double bound = piece.bound(point); bound < lowest)
    {
      likely = &piece;
      lowest = bound;
    }
  if (likely == nullptr)
    return -1;
  const double enough = distanceTo(*likely, point);
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_)
  {
    if (piece.bound(point) > enough + kRounding)
      continue;
    const double distance = distanceTo(piece, point);
    if (distance >= least)
      continue;
    least = distance;
    nearest = piece.branch;
  }
  return nearest;
}

}  // namespace endovascular_sim::vessel
