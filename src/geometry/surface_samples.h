#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** A point of a surface that stands for some of its area. */
struct SurfaceSample
{
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit, of its triangle
  double area;             ///< [m²]
};

using TrianglePart = std::array<Eigen::Vector3d, 3>;

/** Halves a triangle across its longest edge until no edge is longer than @p longest [m]; none without area. */
std::vector<TrianglePart> cutTriangle(const TrianglePart& triangle, double longest);

/** Centres of the pieces into which the triangles from @p first to before @p last are cut until no edge is longer than
 *  @p spacing [m]; triangles without area give none. */
std::vector<SurfaceSample> sampleSurface(const TriangleMesh& mesh, double spacing, std::size_t first = 0,
                                         std::size_t last = static_cast<std::size_t>(-1));

/** How far points of one surface are from another. */
struct Deviation
{
  double largest = 0.0;                             ///< one side of Hausdorff's distance [m]
  double rms = 0.0;                                 ///< over the area [m]
  double p99 = 0.0;                                 ///< what 99 % of the area keeps within [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the largest [m]
  double beyond = 0.0;                              ///< area beyond the stated distance [m²]
};

/** @param distances [m], one per sample
 *  @param stated distance [m] beyond which area is counted */
Deviation deviationOf(const std::vector<SurfaceSample>& samples, const std::vector<double>& distances, double stated);

}  // namespace endovascular_sim::geometry
