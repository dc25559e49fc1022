#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Line of sight from a point of the wall along its normal. All probes of a mesh represent equal areas. */
struct WallProbe
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< point of the wall [m]
  Eigen::Vector3d inward = Eigen::Vector3d::Zero();  ///< unit normal into the lumen
  double across =
      -1.0;  ///< distance to the opposite wall through the lumen, in a round lumen its diameter [m]; −1: none
  double outside = -1.0;  ///< distance to the nearest wall on the outer side [m]; −1: none
};

/** Probes of an outward oriented mesh at points that are spread evenly over its area. The result is deterministic.
 *  @return empty for a mesh without area */
std::vector<WallProbe> probeWall(const geometry::TriangleMesh& mesh, const geometry::MeshDistance& distance);

/** Width that three quarters of the wall do not exceed, measured through the lumen, or on the outer side where the
 *  surface is turned over [m]; 0 without probes. */
double lumenWidth(const std::vector<WallProbe>& probes);

}  // namespace endovascular_sim::vessel
