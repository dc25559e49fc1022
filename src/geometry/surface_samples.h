#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** Quadrature point of a surface. */
struct SurfaceSample
{
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit normal of the triangle
  double area;             ///< area that the sample represents [m²]
};

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/** Longest-edge bisection of a triangle until no edge is longer than @p longest [m]. Degenerate parts are dropped. */
std::vector<TriangleCorners> bisectTriangle(const TriangleCorners& triangle, double longest);

/** Samples of the triangles with indices in [@p first, @p last): centroids of their longest-edge bisection.
 *  @param spacing longest edge of a bisected triangle [m] */
std::vector<SurfaceSample> sampleSurface(const TriangleMesh& mesh, double spacing, std::size_t first = 0,
                                         std::size_t last = static_cast<std::size_t>(-1));

/** Statistics of the distance from one surface to another, weighted by area. */
struct Deviation
{
  double largest = 0.0;                                ///< one-sided Hausdorff distance [m]
  double rms = 0.0;                                    ///< root mean square [m]
  double p99 = 0.0;                                    ///< 99th percentile [m]
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< sample with the largest distance [m]
  double beyond = 0.0;                                 ///< area with a distance above the tolerance [m²]
};

/** Computes the statistics of sampled distances.
 *  @param distances one per sample [m]
 *  @param tolerance distance above which area counts as `beyond` [m] */
Deviation deviationOf(const std::vector<SurfaceSample>& samples, const std::vector<double>& distances,
                      double tolerance);

}  // namespace endovascular_sim::geometry
