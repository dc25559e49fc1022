#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>

namespace endovascular_sim::contact
{

constexpr double kOffTriangle = 1e-9;  ///< m beyond an edge: more is no rounding

/** A triangle as its plane and the three planes across it along its edges: unit normals and negative offsets. */
struct Prism
{
  std::array<Eigen::Array4d, 4> planes;  ///< x, y, z, 1; by lanes the triangle's own towards the lumen, edges' inward
  /** A closest point on its border can be a local minimum in front of it only while the foot lies no farther beyond
   * than so much of the height; infinite: not bounded. */
  double bulge = 0.0;
  std::array<int, 3> own_edges{-1, -1, -1};  ///< the reflex ones of those that belong to it; each mesh edge does to one
  bool has_moved = false;                    ///< it, its edges or what is around them, ever

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
