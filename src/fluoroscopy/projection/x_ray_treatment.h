#pragma once

#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/projection/wire.h"
#include "motion/map/motion_map.h"

namespace endovascular_sim::fluoroscopy
{

/** X-ray model of a balloon filled with diluted contrast medium.
 *  @param axis points along the balloon, two or more [m]
 *  @param radius radius at each point [m]
 *  @param filling density of the filling minus that of the displaced medium */
XRayWire balloonWire(const std::vector<Eigen::Vector3d>& axis, const std::vector<double>& radius,
                     const DeviceDensity& filling);

/** X-ray model of stent struts: round wires with the cross-sectional area of square struts.
 *  @param lines polylines along the struts [m]
 *  @param thickness thickness of the struts [m]
 *  @param metal density of the metal minus that of the displaced medium */
std::vector<XRayWire> strutWires(const std::vector<std::vector<Eigen::Vector3d>>& lines, double thickness,
                                 const DeviceDensity& metal);

/** Moves the nodes of wires from the resting vessel to the moved one. Radii stay. */
void moveWires(const motion::MotionMap& map, std::vector<XRayWire>& wires);

}  // namespace endovascular_sim::fluoroscopy
