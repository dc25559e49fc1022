#pragma once

#include <vector>

#include "fluoroscopy/projection/x_ray_geometry.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::fluoroscopy
{

/** Path length of each pixel's central ray inside a closed mesh [m], between source and detector plane, in row-major
 *  order from the top left.
 *
 *  The ray r(t) = s + t·d with d = (x, y, 1) in the optical frame intersects a face with outward normal n and corner a
 *  at t = n·(a − s) / (n·d). The path length is |d|·Σ ±t: + at exits (n·d > 0), − at entries. Vertices are rounded to
 *  1/4096 pixel, and coverage is computed in integers with a fill rule: a ray through an edge or a vertex intersects
 *  exactly one of the adjacent faces. The result is therefore exact for a mesh with vertices perturbed by less than
 *  1/5000 pixel.
 *
 *  @throws InputError if the mesh extends to the source */
std::vector<double> vesselPathLength(const XRayGeometry& geometry, const geometry::TriangleMesh& mesh);

/** Checks the precondition of vesselPathLength() in one pass over the vertices.
 *  @throws InputError if the mesh extends to the source */
void requireVesselInFrontOfSource(const XRayGeometry& geometry, const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::fluoroscopy
