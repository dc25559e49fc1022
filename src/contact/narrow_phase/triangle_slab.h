#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>

#include "contact/wall/wall.h"

namespace endovascular_sim::contact
{

constexpr double kOffTriangle = 1e-9;  ///< tolerance for rounding beyond an edge of a triangle [m]

/** Bounds of a triangle: its plane, the planes perpendicular to it through its edges, and slopes of normal cones. */
struct alignas(64) TriangleSlab  // the data of every query fill two cache lines
{
  /** Coefficients of x, y, z and 1 of four signed heights. Lane 0: the triangle's plane, positive towards the lumen.
   *  Lanes 1 to 3: the planes through the edges, positive inside. */
  std::array<Eigen::Array4d, 4> planes;
  /** Bound for a local minimum at an edge that the triangle owns, in front of the triangle: the foot's distance from
   *  the edge's line is at most edge_slope · height. Infinite: unbounded. */
  double edge_slope = 0.0;
  double corner_slope = 0.0;                 ///< the same bound for a local minimum at a corner that the triangle owns
  std::array<int, 3> own_edges{-1, -1, -1};  ///< reflex edges that the triangle owns; a mesh edge has one owner
  /** Difference between the cutoff of a query and that of this triangle [m]. The cutoff of a smooth wall includes the
   *  largest deviation of all facets; a triangle needs its own. 0 for facets. */
  double before_cutoff = 0.0;
  bool has_moved = false;  ///< whether the triangle, its edges or a neighbour have ever moved

  /** Bound for any of these local minima: the foot lies at most bulge() · height beyond the triangle's border. */
  double bulge() const { return std::max(edge_slope, corner_slope); }

  Eigen::Vector3d normal() const { return {planes[0][0], planes[1][0], planes[2][0]}; }

  /** Heights of a point over the four planes [m]. */
  Eigen::Array4d heights(const Eigen::Vector3d& point) const
  {
    return planes[0] * point.x() + planes[1] * point.y() + planes[2] * point.z() + planes[3];
  }

  /** Distance of a point's foot beyond the farthest of the lines along the edges; negative inside the triangle [m].
   *  @param heights heights of the point over the planes [m] */
  static double distanceBeyond(const Eigen::Array4d& heights)
  {
    return -std::min({heights[1], heights[2], heights[3]});
  }
};

/** Fills everything but has_moved. */
void setTriangleSlab(const Wall& wall, int triangle, TriangleSlab& slab);

}  // namespace endovascular_sim::contact
