#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::benchmark
{

/** Cost of queries against a tree of one kind of bounding volume. */
struct VolumeResult
{
  std::string name;
  double build_ms = 0.0;        ///< time of building the tree [ms]
  int bytes = 0;                ///< size of a volume
  double collect_us = 0.0;      ///< time of a query for all triangles within a radius of a point [µs]
  double collect_tests = 0.0;   ///< visited volumes per query
  double collect_leaves = 0.0;  ///< triangles found per query
  double nearest_us = 0.0;      ///< time of a query for the nearest triangle [µs]
  double nearest_tests = 0.0;   ///< visited volumes per query
  double nearest_leaves = 0.0;  ///< measured triangles per query
  double mean_distance = 0.0;   ///< mean distance to the nearest triangle, equal for all volumes [m]
};

/** Compares FCL trees of k-DOPs with k = 16, 18, 24, of axis-aligned and of oriented boxes. The same code traverses all
 *  trees with the tightest distance bound of each volume.
 *  @param radius radius of the collecting query [m]
 *  @param repeats number of repetitions, of which the fastest counts */
std::vector<VolumeResult> compareBoundingVolumes(const geometry::TriangleMesh& mesh,
                                                 const std::vector<Eigen::Vector3d>& points, double radius,
                                                 int repeats);

}  // namespace endovascular_sim::benchmark
