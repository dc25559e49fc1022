#pragma once

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Removes caps: triangles with an angle near 180° and without a reliable normal. The longest edge of a cap is flipped,
 *  which moves the surface by at most the height of the cap. Caps are retained if their longest edge is not shared by
 *  two consistently oriented triangles, or if the flipped edge exists already.
 *  @pre no face has a repeated vertex, and there are no duplicate faces: they would make edges non-manifold
 *  @param min_height minimum height of a triangle above its longest edge [m]
 *  @return number of flipped edges */
int removeCaps(geometry::TriangleMesh& mesh, double min_height);

}  // namespace endovascular_sim::vessel
