#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>

namespace endovascular_sim::contact
{

constexpr double kOffTriangle = 1e-9;  ///< m beyond an edge: more is no rounding

/** A triangle as its plane and the three planes across it along its edges: unit normals and negative offsets. */
struct alignas(64) TriangleSlab  // what every search reads fills two cache lines
{
  std::array<Eigen::Array4d, 4> planes;  ///< x, y, z, 1; by lanes the triangle's own towards the lumen, edges' inward
  /** A closest point on an edge that belongs to the triangle can be a local minimum in front of it only while the foot
   * lies no farther from the edge's line than so much of the height; infinite: not bounded. */
  double edge_slope = 0.0;
  double corner_slope = 0.0;                 ///< the same of a closest point at a corner that does, and of that
  std::array<int, 3> own_edges{-1, -1, -1};  ///< the reflex ones of those that belong to it; each mesh edge does to one
  bool has_moved = false;                    ///< it, its edges or what is around them, ever

  /** No foot of such a point lies farther beyond the border than so much of the height. */
  double bulge() const { return std::max(edge_slope, corner_slope); }

  Eigen::Vector3d normal() const { return {planes[0][0], planes[1][0], planes[2][0]}; }

  /** Heights of a point over the four planes [m]. */
  Eigen::Array4d heights(const Eigen::Vector3d& point) const
  {
    return planes[0] * point.x() + planes[1] * point.y() + planes[2] * point.z() + planes[3];
  }

  /** How far a point's foot in the triangle's plane lies beyond the farthest of the lines along its edges, negative
   * inside [m]. @param above the point's heights over the planes [m] */
  static double outsideOf(const Eigen::Array4d& above) { return -std::min({above[1], above[2], above[3]}); }
};

}  // namespace endovascular_sim::contact
