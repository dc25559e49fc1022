#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "contact/wall.h"

namespace endovascular_sim::contact
{

/** Bounding volume hierarchy of axis-aligned boxes over the wall's triangles.
 *
 *  FCL builds a binary tree; it is copied into nodes of four boxes each, which are looked at together (Wald et al.
 * 2008). The walk is ours: FCL's own sphere query copies and refits the whole model on every call and reports no depth
 * for it (docs/CONTACT.md). Boxes are of single precision, rounded outwards, so that nothing is missed. */
class Bvh
{
public:
  /** @param wall must outlive the tree */
  explicit Bvh(const Wall& wall);

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
  static constexpr int kWidth = 4;
  using Lanes = Eigen::Array<float, kWidth, 1>;

  /** Four boxes [m] with what is in them: a node's index, or ~triangle; the boxes of empty places are inside out. */
  struct alignas(64) Node  // starts on a cache line
  {
    std::array<Lanes, 3> low, high;
    std::array<int, kWidth> child;
  };

  /** A place in a node. */
  struct Place
  {
    int node = -1;
    int lane = 0;
  };

  /** Axis-aligned box of single precision around one of double precision. */
  struct Box
  {
    std::array<float, 3> low, high;
    Box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  };

  /** What of the binary tree the copy needs. */
  struct Binary;

  int copy(const Binary& binary, int root, Place above);
  void setBox(Place place, const Box& box);
  void fitTriangle(int triangle);
  static Lanes gaps(const Node& node, const Box& box, int axis);
  static Lanes squaredGaps(const Node& node, const Box& box);

  std::vector<Node> nodes_;      ///< children stand behind their parents
  std::vector<Place> place_of_;  ///< of each triangle
  std::vector<Place> above_;     ///< of each node; the root has none
  std::vector<char> marked_;     ///< per node
  std::vector<int> ancestors_;
  const Wall* wall_;
};

}  // namespace endovascular_sim::contact
