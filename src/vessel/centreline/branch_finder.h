#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Tells to which branch of a centreline a point of the wall belongs. */
class BranchFinder
{
public:
  explicit BranchFinder(const CentrelineTree& tree);

  /** The branch whose lumen is nearest: the least distance from the point to the branch's centreline minus the lumen's
   *  radius there, so that the wall of a wide parent beside an ostium belongs to the parent although the child's
   *  centreline begins inside it. Of equals the first in the tree.
   *  @param point patient frame [m]
   *  @return index into CentrelineTree::branches; −1 when the tree has no points */
  int nearest(const Eigen::Vector3d& point) const;

private:
  /** Some segments of a branch, one after the other, and what is needed to pass over them when they are too far away.
   */
  struct Piece
  {
    int branch = 0;
    std::size_t first = 0;  ///< point at which its first segment begins
    std::size_t last = 0;   ///< where its last one ends
    Eigen::AlignedBox3d box;
    double widest = 0.0;  ///< largest radius [m]

    /** No more than the distance from a point to the lumen [m]. */
    double bound(const Eigen::Vector3d& point) const { return box.exteriorDistance(point) - widest; }
  };

  double distanceTo(const Piece& piece, const Eigen::Vector3d& point) const;

  std::vector<CentrelineBranch> branches_;
  std::vector<Piece> pieces_;
};

}  // namespace endovascular_sim::vessel
