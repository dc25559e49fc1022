#pragma once

#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/projection/wire_projection.h"

namespace endovascular_sim::fluoroscopy
{

/** X-ray model of a balloon filled with diluted contrast medium.
 *  @param axis points along the balloon, two or more [m]
 *  @param radius radius at each point [m]
 *  @param attenuation attenuation coefficient of the filling minus that of the displaced medium [1/m] */
XRayWire balloonWire(std::vector<Eigen::Vector3d> axis, std::vector<double> radius, double attenuation);

/** X-ray model of stent struts: round wires with the cross-sectional area of square struts.
 *  @param lines polylines along the struts [m]
 *  @param thickness thickness of the struts [m]
 *  @param attenuation attenuation coefficient of the metal minus that of the displaced medium [1/m] */
std::vector<XRayWire> strutWires(const std::vector<std::vector<Eigen::Vector3d>>& lines, double thickness,
                                 double attenuation);

}  // namespace endovascular_sim::fluoroscopy
