#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "contact/wall/wall.h"

namespace endovascular_sim::contact
{

/** Bounding volume hierarchy of axis-aligned boxes over the wall's triangles.
 *
 *  FCL builds a binary tree. It is copied into nodes of four boxes each, which are tested together (Wald et al. 2008).
 *  FCL's own sphere query copies and refits the whole model on every call and reports no penetration depth, so the
 *  traversal is part of this class. Boxes are of single precision, rounded outwards: no triangle is missed. Cones of
 *  the triangles' normals cull boxes that contain no local minimum of the distance (spatialised normal cones: Johnson
 *  & Cohen 2001). */
class Bvh
{
public:
  /** @param wall must outlive the tree */
  explicit Bvh(const Wall& wall);

  /** A copy that refers to a copy of the other tree's wall. @param wall must outlive the tree */
  Bvh(const Bvh& other, const Wall& wall) : Bvh(other) { wall_ = &wall; }

  Bvh& operator=(const Bvh&) = delete;

  /** Normal cone of a triangle: bounds of the offset's tangent to the triangle's normal, for points in front of the
   *  triangle that have a local minimum of the distance there. Infinite: unbounded. */
  struct Cone
  {
    double facet = std::numeric_limits<double>::infinity();  ///< minimum on the triangle or its border
    /** Minimum between an edge of the wire and a reflex edge that the triangle owns; negative: it owns none. */
    double reflex_edge = std::numeric_limits<double>::infinity();
  };
  /** Sets the cones. Before the call all cones are open: nothing is culled by them. @param cones per triangle */
  void setCones(const std::vector<Cone>& cones);
  /** Opens the cones of some triangles and of the boxes that contain them. */
  void openCones(const std::vector<int>& triangles);

  /** A segment of query points. */
  struct QuerySegment
  {
    Eigen::Vector3d begin;
    Eigen::Vector3d along;  ///< vector to the segment's end [m]
    double cutoff = 0.0;    ///< largest distance of interest from the points, skin included [m]
    double skin = 0.0;      ///< largest displacement of the points [m]
  };
  /** Appends every triangle that may be the closest feature to a point of a segment. Unordered, without duplicates; may
   *  contain false positives.
   *  @param facets segment for the triangles themselves
   *  @param reflex_edges segment for their reflex edges
   *  @param triangles receives triangles near @p facets
   *  @param owners receives triangles that own a reflex edge near @p reflex_edges */
  void collect(const QuerySegment& facets, const QuerySegment& reflex_edges, std::vector<int>& triangles,
               std::vector<int>& owners) const;

  /** The triangle nearest to a point. */
  struct Nearest
  {
    int triangle = -1;      ///< −1 if none is closer than the given distance
    double distance = 0.0;  ///< [m]
  };
  /** Nearest triangle to a point; the lowest index at equal distances.
   *  @param hint triangle to start with, or −1; the result does not depend on it */
  Nearest nearest(const Eigen::Vector3d& point, double max_distance, int hint = -1) const;

  /** Fits the boxes to moved triangles; the topology of the tree remains. Results stay exact. Queries become slower
   *  where triangles move far relative to each other. */
  void refit(const std::vector<int>& triangles);

  double distanceTo(int triangle, const Eigen::Vector3d& point) const;  ///< [m]

private:
  Bvh(const Bvh&) = default;

  static constexpr int kWidth = 4;
  static constexpr int kMaxDepth = 384;  ///< capacity of the traversal stack
  using Lanes = Eigen::Array<float, kWidth, 1>;

  /** Four boxes [m] with their children: a node's index, or ~triangle. Boxes of empty lanes are inverted. */
  struct alignas(64) Node  // starts on a cache line
  {
    std::array<Lanes, 3> low, high;
    std::array<int, kWidth> child;
  };

  /** Normal cones of a node's four boxes. */
  struct alignas(64) Cones
  {
    std::array<Lanes, 3> axis;  ///< unit
    /** Cylinders around the axes that contain the boxes' triangles, relative to the boxes' centres at construction [m].
     *  Boxes that move have open cones. */
    Lanes radius, bottom, top;
    Lanes facet, reflex_edge;  ///< as in Cone, relative to the axis; kOpen: unbounded
  };

  /** A lane of a node. */
  struct Slot
  {
    int node = -1;
    int lane = 0;
  };

  /** Axis-aligned box of single precision around one of double precision. */
  struct Box
  {
    std::array<float, 3> low, high;
    Box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
    explicit Box(const Node& node);  ///< union of a node's boxes
  };

  /** A QuerySegment in single precision with its tests. */
  struct SegmentTest;

  /** FCL's binary tree. */
  struct Binary;

  int copy(const Binary& binary, int root, Slot above);
  void setBox(Slot slot, const Box& box);
  void fitTriangle(int triangle);
  void openAllCones();
  void setCone(Slot slot, const Eigen::Vector3d& axis, const Cone& cone);
  void widenCone(int node);
  void enclose(int triangle, Slot slot);
  bool ownsReflexEdge(int node, int lane) const { return ((reflex_lanes_[node] >> lane) & 1) != 0; }
  /** Distances of four boxes from another box along an axis; negative where they overlap [m]. */
  static Lanes gaps(const Node& node, const Box& box, int axis)
  {
    return (node.low[axis] - box.high[axis]).max(box.low[axis] - node.high[axis]);
  }
  static Lanes squaredGaps(const Node& node, const Box& box);

  std::vector<Node> nodes_;                 ///< parents precede their children
  std::vector<Cones> cones_;                ///< per node
  std::vector<char> has_cones_;             ///< per node: whether testing its cones pays
  std::vector<std::uint8_t> reflex_lanes_;  ///< per node, a bit per box: whether it contains a reflex edge's owner
  std::vector<Slot> slot_of_;               ///< per triangle
  std::vector<Slot> above_;                 ///< per node: slot in its parent; none for the root
  std::vector<char> marked_;                ///< per node
  std::vector<int> ancestors_;
  const Wall* wall_;
};

}  // namespace endovascular_sim::contact
