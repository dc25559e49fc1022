#pragma once

#include <cstdint>
#include <vector>

#include "fluoroscopy/projection/x_ray_geometry.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::fluoroscopy
{

/** Vertex in the image. */
struct Corner
{
  std::int64_t column = 0;  ///< [1/4096 pixel]
  std::int64_t row = 0;     ///< [1/4096 pixel]
  double inverse_depth = 0.0;
};

/** @throws InputError if the vertex is at the source or behind it */
Corner projectCorner(const XRayGeometry& geometry, const Eigen::Vector3d& vertex);

/** Adds the signed depth of a triangle, limited to the detector, to every pixel whose central ray intersects it: +
 *  where rays leave the mesh, − where they enter it. Coverage as in vesselPathLength(). */
void addTriangle(const Corner& a, const Corner& b, const Corner& c, double detector_depth, int pixels,
                 std::vector<double>& sum);

/** Length along each pixel's ray [m] from the sum of signed depths. */
void depthsToLengths(const XRayGeometry& geometry, std::vector<double>& sum);

}  // namespace endovascular_sim::fluoroscopy
