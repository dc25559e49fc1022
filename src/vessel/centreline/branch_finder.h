#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Assigns points to the branches of a centreline. */
class BranchFinder
{
public:
  explicit BranchFinder(const CentrelineTree& tree);

  /** Branch with the nearest lumen: the least distance to a branch's centreline minus the lumen's radius at the foot
   *  point. The radius matters beside an ostium: the parent's wall belongs to the parent, although the child's
   *  centreline begins inside the parent. Among equals, the first branch of the tree is returned.
   *  @param point patient frame [m]
   *  @return index into CentrelineTree::branches; −1 if the tree has no points, or for a point that is not finite */
  int nearest(const Eigen::Vector3d& point) const;

  /** Name of that branch; empty if there is none. */
  std::string nameAt(const Eigen::Vector3d& point) const;

private:
  /** Consecutive segments of a branch with a bounding box for culling. */
  struct Block
  {
    int branch = 0;
    std::size_t first = 0;    ///< index of the first point
    std::size_t last = 0;     ///< index of the last point
    Eigen::AlignedBox3d box;  ///< bounding box of the points
    double widest = 0.0;      ///< largest radius [m]

    /** Lower bound of the signed distance from a point to the lumen [m]. */
    double bound(const Eigen::Vector3d& point) const { return box.exteriorDistance(point) - widest; }
  };

  double distanceTo(const Block& block, const Eigen::Vector3d& point) const;

  std::vector<CentrelineBranch> branches_;
  std::vector<Block> blocks_;
};

}  // namespace endovascular_sim::vessel
