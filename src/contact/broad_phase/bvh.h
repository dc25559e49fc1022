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
 *  FCL builds a binary tree; it is copied into nodes of four boxes each, which are looked at together (Wald et al.
 * 2008). The walk is ours: FCL's own sphere query copies and refits the whole model on every call and reports no depth
 * for it (docs/CONTACT.md). Boxes are of single precision, rounded outwards, so that nothing is missed. Cones round the
 * normals of what is in a box tell from where it can be closest at all (spatialised normal cones: Johnson & Cohen
 * 2001). */
class Bvh
{
public:
  /** @param wall must outlive the tree */
  explicit Bvh(const Wall& wall);

  /** How far off a triangle's normal a point in front of it can lie, seen from the place that is the closest one of the
   * wall around it: tangents, infinite for anywhere. */
  struct Cone
  {
    double facet = std::numeric_limits<double>::infinity();  ///< from the triangle, its border included
    double ridge = std::numeric_limits<double>::infinity();  ///< from one of its ridges; negative: it has none
  };
  /** Without them, and after openCones, anything may be closest from anywhere. @param cones per triangle */
  void setCones(const std::vector<Cone>& cones);
  void openCones(const std::vector<int>& triangles);

  /** Places along a segment from which it is looked for what is closest. */
  struct View
  {
    Eigen::Vector3d begin;
    Eigen::Vector3d along;  ///< to the end [m]
    double farthest = 0.0;  ///< from the places, how far what is wanted may lie [m]
    double room = 0.0;      ///< by which the places may still move, contained in the former [m]
  };
  /** Appends every triangle that may be closest to a place of @p facets, and every one with a ridge that may be to a
   * place of @p ridges; in any order, none twice, some that cannot are among them. */
  void collect(const View& facets, const View& ridges, std::vector<int>& triangles, std::vector<int>& ridged) const;

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
  static constexpr int kMaxDepth = 384;  ///< of places that wait to be looked at
  using Lanes = Eigen::Array<float, kWidth, 1>;

  /** Four boxes [m] with what is in them: a node's index, or ~triangle; the boxes of empty places are inside out. */
  struct alignas(64) Node  // starts on a cache line
  {
    std::array<Lanes, 3> low, high;
    std::array<int, kWidth> child;
  };

  /** Cones round the normals of what is in a node's boxes. */
  struct alignas(64) Cones
  {
    std::array<Lanes, 3> axis;  ///< unit
    /** Of the cylinders about the axes round what is in the boxes, from the boxes' middles, as made [m]: boxes that
     * move have open cones. */
    Lanes radius, bottom, top;
    Lanes facet, ridge;  ///< as of a Cone, about the axis; kOpen: anywhere
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
    explicit Box(const Node& node);  ///< round all of a node's boxes
  };

  /** A view in lanes' precision. */
  struct Sight;

  /** What of the binary tree the copy needs. */
  struct Binary;

  int copy(const Binary& binary, int root, Place above);
  void setBox(Place place, const Box& box);
  void fitTriangle(int triangle);
  void openAllCones();
  void setCone(Place place, const Eigen::Vector3d& axis, const Cone& cone);
  void widenCone(int node);
  void enclose(int triangle, Place place);
  bool hasRidge(int node, int lane) const { return ((ridged_[node] >> lane) & 1) != 0; }
  /** How far four boxes are from another one along an axis; negative where they overlap [m]. */
  static Lanes gaps(const Node& node, const Box& box, int axis)
  {
    return (node.low[axis] - box.high[axis]).max(box.low[axis] - node.high[axis]);
  }
  static Lanes squaredGaps(const Node& node, const Box& box);

  std::vector<Node> nodes_;           ///< children stand behind their parents
  std::vector<Cones> cones_;          ///< of each node
  std::vector<char> pointed_;         ///< per node: whether its cones are worth a look
  std::vector<std::uint8_t> ridged_;  ///< per node, a bit per box: whether something in it has a ridge
  std::vector<Place> place_of_;       ///< of each triangle
  std::vector<Place> above_;          ///< of each node; the root has none
  std::vector<char> marked_;          ///< per node
  std::vector<int> ancestors_;
  const Wall* wall_;
};

}  // namespace endovascular_sim::contact
