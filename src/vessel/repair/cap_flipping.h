#pragma once

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Takes away caps: triangles that have three corners and no height, whose normals mean nothing. The longest edge is
 *  turned into the other diagonal of the two triangles beside it, so the surface moves by the cap's height at most.
 *  Caps whose edge is not between two triangles that agree, or whose other diagonal is an edge already, stay.
 *  @pre no face names a vertex twice or is there twice: their edges are those of more than two faces
 *  @param least_height that a triangle keeps over its longest edge [m]
 *  @return how many edges were turned */
int flipCaps(geometry::TriangleMesh& mesh, double least_height);

}  // namespace endovascular_sim::vessel
