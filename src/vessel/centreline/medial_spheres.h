#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** A largest sphere that fits between the walls at some place. */
struct MedialSphere
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.0;                               ///< [m]
};

/** Balls in the middle of the lumen: from the midpoint of the chord across it at samples of the wall, away from the
 *  nearest wall up to the ridge of the distance (so that the grooves between facets collect no balls). Triangles longer
 *  than the local radius are sampled several times. The order is that of the triangles. */
std::vector<MedialSphere> medialBalls(const geometry::TriangleMesh& mesh, const geometry::MeshDistance& distance);

/** Thins the balls, largest first: a kept ball drops those whose centre lies within @p cover of its radii, and those
 *  smaller than @p cover of its size whose centre it contains. */
std::vector<MedialSphere> thinBalls(std::vector<MedialSphere> balls, double cover);

/** For every ball the indices of those it overlaps, ascending. Overlapping balls belong to the same lumen. */
std::vector<std::vector<int>> overlappingBalls(const std::vector<MedialSphere>& balls);

/** Makes neighbours of balls that do not overlap where parts of a lumen would else be apart, as at the ostium of a
 * small vessel: the nearest ones first, that see each other and stand apart by no more than the larger one's radius. */
void joinParts(const std::vector<MedialSphere>& balls, const geometry::MeshDistance& distance,
               std::vector<std::vector<int>>& neighbours);

}  // namespace endovascular_sim::vessel
