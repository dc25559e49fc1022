#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>

namespace endovascular_sim::contact
{

constexpr double kOffTriangle = 1e-9;  ///< m beyond an edge: more is no rounding

/** A triangle as its plane and the three planes across it along its edges: unit normals and negative offsets. */
struct alignas(64) Prism  // what every search reads fills two cache lines
{
  std::array<Eigen::Array4d, 4> planes;  ///< x, y, z, 1; by lanes the triangle's own towards the lumen, edges' inward
  /** A closest point on an edge can be a local minimum in front of the triangle only while the foot lies no farther
   * from the edge's line than so much of the height; infinite: not bounded. By the edges' lanes. */
  std::array<double, 3> edge_slopes{};
  std::array<double, 3> corner_slopes{};     ///< the same of a closest point where that edge begins, and of that
  std::array<int, 3> own_edges{-1, -1, -1};  ///< the reflex ones of those that belong to it; each mesh edge does to one
  bool has_moved = false;                    ///< it, its edges or what is around them, ever

  double widestEdge() const { return std::max({edge_slopes[0], edge_slopes[1], edge_slopes[2]}); }
  double widestCorner() const { return std::max({corner_slopes[0], corner_slopes[1], corner_slopes[2]}); }

  /** No foot of such a point lies farther beyond the border than so much of the height. */
  double bulge() const { return std::max(widestEdge(), widestCorner()); }

  /** Whether a closest point on the border can be a local minimum. @param above the point's heights over the planes */
  bool canMeetBorder(const Eigen::Array4d& above) const
  {
    const double height = above[0];
    if (height <= kOffTriangle)
      return true;  // behind the plane anything will do
    for (int k = 0, before = 2; k < 3; before = k++)
    {
      const double beyond = -above[k + 1];
      const double from_corner = std::max(std::abs(beyond), std::abs(above[before + 1]));
      if (from_corner <= corner_slopes[k] * height + kOffTriangle)
        return true;
      if (beyond >= -kOffTriangle && beyond <= edge_slopes[k] * height + kOffTriangle)
        return true;
    }
    return false;
  }

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
