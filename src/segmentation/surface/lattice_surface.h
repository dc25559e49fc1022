#pragma once

#include "geometry/triangle_mesh.h"
#include "segmentation/surface/lattice_field.h"

namespace endovascular_sim::segmentation
{

/** Zero level of a field by marching tetrahedra, of which only the component with the most triangles is kept: closed,
 * two-manifold, outward oriented [m].
 *  @param components receives the number of components, if not null */
geometry::TriangleMesh latticeSurface(const LatticeField& field, int* components = nullptr);

}  // namespace endovascular_sim::segmentation
