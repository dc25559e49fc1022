#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/progress.h"
#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Medial sphere: a maximal inscribed sphere of the lumen. */
struct MedialSphere
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.0;                               ///< [m]
};

/** Medial spheres of the lumen. From each sample of the wall, the distance to the wall is maximised from the midpoint
 *  of the chord across the lumen. Spheres in grooves between facets are discarded. Triangles longer than the local
 *  radius are sampled several times. The order follows the triangles and is independent of the number of threads that
 *  share the samples. */
std::vector<MedialSphere> medialSpheres(const geometry::TriangleMesh& mesh, const geometry::MeshDistance& distance,
                                        const ProgressReport& progress = {});

/** Thins spheres by decreasing radius. A retained sphere of radius r removes spheres with a centre within @p cover·r of
 *  its centre, and spheres with a radius below @p cover·r and a centre inside it. */
std::vector<MedialSphere> thinSpheres(std::vector<MedialSphere> spheres, double cover);

/** Overlap graph: per sphere, the ascending indices of overlapping spheres, which belong to the same lumen. */
std::vector<std::vector<int>> overlappingSpheres(const std::vector<MedialSphere>& spheres);

/** Connects components of the overlap graph, for instance at the ostium of a small vessel. Pairs of spheres are
 *  connected by increasing gap if their line of sight is free and their gap is at most the larger radius. */
void connectComponents(const std::vector<MedialSphere>& spheres, const geometry::MeshDistance& distance,
                       std::vector<std::vector<int>>& neighbours);

}  // namespace endovascular_sim::vessel
