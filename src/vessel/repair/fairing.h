#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Takes the facets' edges out of a closed mesh of even triangles: a low-pass filter over its edges that keeps waves
 *  longer than about ten edges, so that lumens do not shrink. G. Taubin, "A signal processing approach to fair surface
 *  design", 1995, pass band 0.1. No vertex ends farther than its limit from where it stood.
 *  @param limits largest movement per vertex [m]
 *  @param rounds 0 leaves the mesh as it is; 30 take out most of what can be */
void fair(geometry::TriangleMesh& mesh, const std::vector<double>& limits, int rounds);

}  // namespace endovascular_sim::vessel
