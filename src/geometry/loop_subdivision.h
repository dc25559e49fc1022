#pragma once

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** Loop subdivision of a closed mesh. Every level splits each triangle into four. The limit surface is C², and C¹ at
 *  vertices of valence other than six. C. Loop, "Smooth Subdivision Surfaces Based on Triangles", 1987. Convex regions
 *  shrink: by about 1 % of the radius for 20 facets around a lumen.
 *  @pre the mesh is closed and manifold (checkMesh)
 *  @param levels number of subdivisions; 0 returns the mesh */
TriangleMesh loopSubdivision(TriangleMesh mesh, int levels);

/** Midpoint subdivision of a closed mesh: every triangle is split into four, and the surface is unchanged.
 *  @pre the mesh is closed and manifold (checkMesh)
 *  @param levels number of subdivisions; 0 returns the mesh */
TriangleMesh midpointSubdivision(TriangleMesh mesh, int levels);

}  // namespace endovascular_sim::geometry
