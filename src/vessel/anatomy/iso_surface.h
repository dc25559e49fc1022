#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace endovascular_sim::vessel
{

/** Closed two-manifold surface of the field's zero level, outward oriented, of uneven triangles.
 *
 *  Cubes cut into tetrahedra are bisected near the wall down to the field's facet length (J. M. Maubach, "Local
 * bisection refinement for n-simplicial grids", 1995), then each tetrahedron is cut by the wall (marching tetrahedra).
 * Where the surface passes, the tetrahedra conform, so that it cannot have holes. The libraries at hand sample on an
 * even grid, which would need 0.3 mm everywhere for the coronaries' sake. */
geometry::TriangleMesh isoSurface(const ImplicitVessel& field);

}  // namespace endovascular_sim::vessel
