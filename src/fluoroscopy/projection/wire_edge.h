#pragma once

#include <vector>

#include "fluoroscopy/projection/wire.h"
#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Cylinder of a wire with clipping planes, in the optical frame. */
struct WireEdge
{
  /** Cylinder with end planes normal to its axis.
   *  @pre the ends are distinct */
  WireEdge(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const WireProfile& layers);

  Eigen::Vector3d begin, end;                ///< ends of the axis [m]
  Eigen::Vector3d axis;                      ///< unit vector from begin to end
  Eigen::Vector3d begin_normal, end_normal;  ///< unit normals of the clipping planes, oriented along the axis
  Eigen::Vector3d moment, across;            ///< a × p and p⊥ of the chord formula [m]
  double depth;                              ///< depth of the midpoint, the t of its ray [m]
  double radius;                             ///< largest radius of the layers [m]
  double length;                             ///< [m]
  const WireProfile* profile;
  /** Lengths beyond begin and end over which the wire continues with the same profile, straight within a tolerance [m].
   */
  double straight_before = 0.0, straight_after = 0.0;
  int first_straight = 0, last_straight = 0;  ///< edges of the wire that the straight part touches

  /** Extension of the cylinder beyond the end of its axis by an oblique clipping plane [m]. */
  double mitreDepth(const Eigen::Vector3d& normal) const;
};

/** Appends the edges of a wire: collinear edges merged, joints mitred, invisible edges omitted.
 *  @param wire must outlive the edges */
void appendEdges(const XRayGeometry& geometry, const XRayWire& wire, std::vector<WireEdge>& edges);

}  // namespace endovascular_sim::fluoroscopy
