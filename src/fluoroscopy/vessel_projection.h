#pragma once

#include <vector>

#include "fluoroscopy/x_ray_geometry.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::fluoroscopy
{

/** Length [m] of each pixel's central ray inside a closed mesh, row by row from the top left, between the source and
 *  the detector's plane.
 *
 *  With the ray r(t) = s + t·d, d = (x, y, 1) in the optical frame, face i with outward normal n and corner a is met at
 *  t = n·(a − s) / (n·d), and the length inside is |d|·Σ ±t: + where the ray leaves (n·d > 0), − where it enters.
 *  Corners are rounded to 1/4096 pixel and coverage is decided in integers by a rule that gives a ray through an edge
 * or a corner to exactly one of the faces around it, so no pixel is counted twice or missed: the sum is the length
 *  inside a mesh whose corners have moved by less than 1/5000 pixel.
 *
 *  @throws InputError when the mesh reaches the source: move the isocentre or the source */
std::vector<double> vesselPathLength(const XRayGeometry& geometry, const geometry::TriangleMesh& mesh);

/** Throws the InputError that vesselPathLength() would throw, at the price of one pass over the corners. */
void requireVesselBeforeSource(const XRayGeometry& geometry, const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::fluoroscopy
