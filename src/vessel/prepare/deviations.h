#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/prepare/prepare_report.h"
#include "vessel/repair/hole_closing.h"

namespace endovascular_sim::vessel
{

/** Input surfaces for the comparison with the result. */
struct InputSurfaces
{
  const geometry::TriangleMesh& soup;    ///< triangles of the input, then lids of holes, then bridges
  std::size_t own_triangles;             ///< number of triangles of the input, at the front of the soup
  const geometry::TriangleMesh& united;  ///< outer wall at the resolution of the grid
  double voxel;                          ///< edge of a voxel [m]
};

/** Measures the distances from the input's outer wall to the result. The report receives the area of inner walls, which
 *  are excluded. */
void measureInputToResult(const InputSurfaces& input, const geometry::TriangleMesh& result, PrepareReport& report);

/** Measures the distances from the result to the input. The report receives the area of lids and bridges, which are
 *  excluded. */
void measureResultToInput(const InputSurfaces& input, const geometry::TriangleMesh& result, PrepareReport& report);

/** Samples gaps between walls of the input that are narrower than two voxels, and counts those that the result retains.
 *  */
NarrowGaps measureGaps(const InputSurfaces& input, const geometry::TriangleMesh& result);

}  // namespace endovascular_sim::vessel
