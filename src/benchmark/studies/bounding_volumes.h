#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::benchmark
{

/** What queries against a tree of one kind of bounding volume take. */
struct VolumeResult
{
  std::string name;
  double build_ms = 0.0;
  int bytes = 0;                ///< of a volume
  double collect_us = 0.0;      ///< per query of all triangles within a radius of a point, from the root
  double collect_tests = 0.0;   ///< volumes looked at, per query
  double collect_leaves = 0.0;  ///< triangles left over, per query
  double nearest_us = 0.0;      ///< per query of the nearest triangle, from the root
  double nearest_tests = 0.0;
  double nearest_leaves = 0.0;  ///< triangles whose distance was taken, per query
  double mean_distance = 0.0;   ///< of the points to their nearest triangles: the same for all volumes [m]
};

/** Trees of FCL over k-DOPs with k = 16, 18, 24, over axis-aligned and over oriented boxes, all walked by the same code
 *  with each volume's own best bound of the distance to a point.
 *  @param radius of the collecting query [m]
 *  @param repeats of all queries; times are those of the fastest */
std::vector<VolumeResult> compareBoundingVolumes(const geometry::TriangleMesh& mesh,
                                                 const std::vector<Eigen::Vector3d>& points, double radius,
                                                 int repeats);

}  // namespace endovascular_sim::benchmark
