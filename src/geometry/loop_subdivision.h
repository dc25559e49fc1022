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

/** Interpolating subdivision by normals (Yang 2006, "Normal based subdivision scheme for curve design"): every triangle
 * is split into four, vertices stay, and the middle of an edge moves along the mean of its ends' normals to the circle
 * that fits both. A sphere and a cylinder stay exact. Ends at a crease, where a triangle is turned against the mean
 * normal by more than the crease angle, do not bend their edges: a flat cap and its rim remain.
 *  @pre the mesh is closed and manifold (checkMesh)
 *  @param levels number of subdivisions; 0 returns the mesh
 *  @param crease_angle [rad] */
TriangleMesh normalSubdivision(TriangleMesh mesh, int levels, double crease_angle);

}  // namespace endovascular_sim::geometry
