#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/lesion/lesion_shape.h"

namespace endovascular_sim::vessel
{

/** The mesh with a lesion: the wall is moved inwards and meshed anew there, in stages between which facets do not
 *  stretch too far. Vertices outside the lesion stay as they are.
 *  @param branch before any lesion
 *  @param middle of the lesion along it [m] */
geometry::TriangleMesh narrowedMesh(geometry::TriangleMesh mesh, const CentrelineBranch& branch, const Lesion& lesion,
                                    double middle);

/** Whether some face within a lesion looks into the lumen.
 *  @param mesh with the lesion
 *  @param healthy without it */
bool wallFolds(const geometry::TriangleMesh& mesh, const geometry::TriangleMesh& healthy, const LesionShape& shape);

}  // namespace endovascular_sim::vessel
