#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace endovascular_sim::vessel
{

/** Closed, outward oriented two-manifold mesh of the field's zero level, with triangles of uneven quality.
 *
 *  Marching tetrahedra on an adaptive grid: tetrahedra near the wall are bisected down to the target edge length (J. M.
 *  Maubach, "Local bisection refinement for n-simplicial grids", 1995). The grid is conforming at the surface, so that
 *  the surface has no holes. A uniform grid would need a spacing of 0.3 mm everywhere because of the coronaries. */
geometry::TriangleMesh isoSurface(const ImplicitVessel& field);

}  // namespace endovascular_sim::vessel
