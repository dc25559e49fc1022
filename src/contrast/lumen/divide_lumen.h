#pragma once

#include "contrast/cells/contrast_cells.h"
#include "contrast/lumen/lumen_cells.h"
#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::contrast
{

/** Largest distance of a mouth's rim from the centreline, in radii of the lumen. */
constexpr double kWidestMouth = 1.6;

/** Divides the lumen of a vessel into cells.
 *
 *  A branch begins at the first plane, from its first cell on, on which all of the rim is within kWidestMouth radii of
 * its centreline: it has left the lumen of its parent, and bulges such as sinuses belong to the parent. Where there is
 * no such plane within eight radii of the parent, the plane of the narrowest rim counts. No other branch passes through
 * it.
 *  @param mesh closed, outward oriented wall
 *  @param cells of the branches of @p centreline
 *  @throws InputError if the cells do not belong to the centreline */
LumenCells divideLumen(const geometry::TriangleMesh& mesh, const vessel::CentrelineTree& centreline,
                       const ContrastCells& cells);

}  // namespace endovascular_sim::contrast
