#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Taubin λ|μ smoothing of a closed mesh of isotropic triangles. The low-pass filter retains wavelengths above about
 *  ten edges, so that lumens do not shrink. G. Taubin, "A signal processing approach to fair surface design", 1995,
 *  pass band 0.1.
 *  @param limits largest displacement per vertex [m]
 *  @param rounds number of λ|μ steps; 0 leaves the mesh unchanged */
void fair(geometry::TriangleMesh& mesh, const std::vector<double>& limits, int rounds);

}  // namespace endovascular_sim::vessel
