#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/prepare/prepare_report.h"
#include "vessel/repair/hole_closing.h"

namespace endovascular_sim::vessel
{

/** The input in the forms in which it is compared with the result. */
struct InputSurfaces
{
  const geometry::TriangleMesh& soup;    ///< the input, then the lids of its holes, then bridges
  std::size_t own_triangles;             ///< of the input: the first ones of the soup
  const geometry::TriangleMesh& united;  ///< its outer wall, as fine as a voxel
  double voxel;                          ///< [m]
};

/** Fills in the distances both ways and the areas left out of them. The input's walls that lie inside of another of its
 *  pieces, or of its outer wall, are left out one way, lids and bridges the other way. */
void measureDeviations(const InputSurfaces& input, const geometry::TriangleMesh& result, PrepareReport& report);

/** Looks across every space outside of the input's walls that is narrower than two voxels, and whether the result has
 *  it still. */
NarrowGaps measureGaps(const InputSurfaces& input, const geometry::TriangleMesh& result);

}  // namespace endovascular_sim::vessel
