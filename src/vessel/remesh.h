#pragma once

#include "vessel/mesh.h"
#include "vessel/vessel_field.h"

namespace endovascular_sim::vessel
{

/** Makes the triangles of a closed two-manifold mesh even, at the field's facet length, with every vertex on the wall.
 *
 *  Splits, collapses and flips of edges that keep the topology, tangential smoothing, and Newton projection on the
 * field (M. Botsch, L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004, with lengths that vary). */
TriangleMesh remesh(const TriangleMesh& mesh, const VesselField& field);

}  // namespace endovascular_sim::vessel
