#pragma once

#include <string>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** A plane across a vessel near one of its ends. */
struct EndCut
{
  Eigen::Vector3d place = Eigen::Vector3d::Zero();     ///< on the centreline [m]
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  ///< unit, towards the end
  double reach = 0.0;                                  ///< nothing farther from the place than this may be cut off [m]
};

/** Cuts off what lies beyond the plane and is connected with the tip that the outward direction meets: the vessel is
 *  open there, its rim lies in the plane. Vertices next to the plane are moved onto it, so that no slivers arise.
 *  @param source names the mesh in errors
 *  @throws InputError when the plane would cut off more than the end */
geometry::TriangleMesh cutEnd(const geometry::TriangleMesh& mesh, const EndCut& cut, const std::string& source);

}  // namespace endovascular_sim::vessel
