#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Options of the united surface. */
struct SurfaceSettings
{
  double spacing = 2.5e-4;  ///< of the lattice [m]
  double blend = 1.0;       ///< blending range where branches meet, in radii of the smaller branch
  int threads = 0;          ///< 0: number of processors
};

/** Surface of the union of all branches: closed, two-manifold, outward oriented; grid frame [m].
 *
 *  The union is the smooth minimum of the tubes on a lattice. The blending range is in proportion to 1 − cos of the
 * angle between the tubes' normals: it closes the crotch of two branches that run side by side before they join, and
 * leaves a wall that two tubes share where it is. The surface is that of marching tetrahedra; its largest component is
 * kept.
 *  @param components receives the number of components, if not null */
geometry::TriangleMesh lumenSurface(const std::vector<LumenBranch>& branches, const SurfaceSettings& settings,
                                    int* components = nullptr);

/** Genus of a closed mesh of one component, by Euler's formula. */
int genusOf(const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::segmentation
