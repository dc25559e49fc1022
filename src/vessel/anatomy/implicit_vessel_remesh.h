#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace endovascular_sim::vessel
{

/** Isotropic remeshing of a closed mesh onto the zero level of an implicit vessel (vessel/repair/remesh.h). */
geometry::TriangleMesh remesh(const geometry::TriangleMesh& mesh, const ImplicitVessel& field);

}  // namespace endovascular_sim::vessel
