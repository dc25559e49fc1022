#pragma once

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** Loop's subdivision of a closed mesh: every level makes four triangles of one and smooths the surface towards a
 *  C² limit (C¹ at vertices with other than six neighbours). C. Loop, "Smooth Subdivision Surfaces Based on
 *  Triangles", 1987. Convex parts shrink a little: about 1 % of the radius for 20 facets around a lumen.
 *  @pre the mesh is closed and manifold (checkMesh)
 *  @param levels how often; 0 returns the mesh */
TriangleMesh loopSubdivision(TriangleMesh mesh, int levels);

/** The same triangles cut in four at their edges' midpoints: another mesh of exactly the same surface.
 *  @pre as above */
TriangleMesh flatSubdivision(TriangleMesh mesh, int levels);

}  // namespace endovascular_sim::geometry
