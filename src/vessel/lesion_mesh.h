#pragma once

#include "vessel/centreline.h"
#include "vessel/lesion_shape.h"
#include "vessel/mesh.h"

namespace endovascular_sim::vessel
{

/** The mesh with a lesion: the wall is moved inwards and meshed anew there, in stages between which facets do not
 *  stretch too far. Vertices outside the lesion stay as they are.
 *  @param branch before any lesion
 *  @param middle of the lesion along it [m] */
TriangleMesh narrowedMesh(TriangleMesh mesh, const CentrelineBranch& branch, const Lesion& lesion, double middle);

/** Whether some face within a lesion looks into the lumen.
 *  @param mesh with the lesion
 *  @param healthy without it */
bool wallFolds(const TriangleMesh& mesh, const TriangleMesh& healthy, const LesionShape& shape);

}  // namespace endovascular_sim::vessel
