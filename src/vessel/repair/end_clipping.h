#pragma once

#include <string>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Clipping plane across a vessel near one of its ends. */
struct ClipPlane
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();     ///< intersection with the centreline [m]
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  ///< unit normal, towards the end
  double max_distance = 0.0;                           ///< largest distance of removed vertices from the point [m]
};

/** Clips the end of a vessel: removes the part beyond the plane that is connected to the tip. The rim of the new
 *  opening lies in the plane. Vertices next to the plane are snapped onto it to avoid slivers.
 *  @param source name of the mesh in errors
 *  @throws InputError if the plane would remove more than the end */
geometry::TriangleMesh clipEnd(const geometry::TriangleMesh& mesh, const ClipPlane& plane, const std::string& source);

}  // namespace endovascular_sim::vessel
