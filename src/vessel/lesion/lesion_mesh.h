#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/lesion/lesion_shape.h"

namespace endovascular_sim::vessel
{

/** Mesh with a lesion. The wall is narrowed and remeshed in stages that limit the distortion of facets. Vertices
 *  outside the lesion are unchanged.
 *  @param branch healthy branch
 *  @param middle arc length of the throat on the branch [m] */
geometry::TriangleMesh narrowedMesh(geometry::TriangleMesh mesh, const CentrelineBranch& branch, const Lesion& lesion,
                                    double middle);

/** True if a face within a lesion is inverted.
 *  @param mesh mesh with the lesion
 *  @param healthy mesh without the lesion */
bool hasFoldedFaces(const geometry::TriangleMesh& mesh, const geometry::TriangleMesh& healthy,
                    const LesionShape& shape);

}  // namespace endovascular_sim::vessel
