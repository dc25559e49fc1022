#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace endovascular_sim::vessel
{

/** Remeshes a closed mesh onto the zero level of an implicit vessel, by Newton projection (vessel/repair/remesh.h). */
geometry::TriangleMesh remesh(const geometry::TriangleMesh& mesh, const ImplicitVessel& field);

}  // namespace endovascular_sim::vessel
