#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "contact/wall.h"

namespace endovascular_sim::contact
{

/** Bounding volume hierarchy of axis-aligned boxes over the wall's triangles.
 *
 *  FCL builds the tree; the walk is ours: FCL's own sphere query copies and refits the whole model on every call and
 *  reports no depth for it (docs/CONTACT.md). The finished nodes are copied into one flat array, because FCL's
 *  accessors are calls into its library. */
class Bvh
{
public:
  /** @param wall must outlive the tree */
  explicit Bvh(const Wall& wall);

  /** Appends every triangle whose box is closer than @p radius to the point: a superset of those in the ball. */
  void collect(const Eigen::Vector3d& point, double radius, std::vector<int>& triangles) const;

  /** Appends every triangle whose box meets the box from @p low to @p high [m]. */
  void collectBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::vector<int>& triangles) const;

  /** The triangle nearest to a point. */
  struct Nearest
  {
    int triangle = -1;      ///< −1 when none is closer than the given distance
    double distance = 0.0;  ///< [m]
  };
  /** @param near a triangle that is expected to be near, to start from, or −1; the answer does not depend on it */
  Nearest nearest(const Eigen::Vector3d& point, double max_distance, int near = -1) const;

  /** Fits the boxes to triangles that have moved; the tree keeps its shape. Answers stay exact, but where triangles
   * move far against each other they come more slowly. */
  void refit(const std::vector<int>& triangles);

  double distanceTo(int triangle, const Eigen::Vector3d& point) const;  ///< [m]

private:
  /** A box with its children (left at `left`, right at `left` + 1), or its triangle in a leaf. */
  struct Node
  {
    std::array<double, 3> low;
    std::array<double, 3> high;
    int left = -1;
    int triangle = -1;
  };

  static double squaredDistance(const Node& node, const Eigen::Vector3d& point);

  void fitLeaf(Node& leaf) const;

  std::vector<Node> nodes_;            ///< children stand behind their parents
  std::vector<int> parent_, leaf_of_;  ///< per node; per triangle
  std::vector<char> marked_;           ///< per node
  std::vector<int> ancestors_;
  const Wall* wall_;
};

}  // namespace endovascular_sim::contact
