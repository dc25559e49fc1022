#pragma once

#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/wire_projection.h"

namespace endovascular_sim::fluoroscopy
{

/** A balloon filled with diluted contrast, as X-rays see it.
 *  @param axis, radius along the balloon, two points or more [m]
 *  @param attenuation of its filling less that of what it displaces [1/m] */
XRayWire balloonWire(std::vector<Eigen::Vector3d> axis, std::vector<double> radius, double attenuation);

/** Struts of a stent as wires of a square cross-section's area.
 *  @param lines along the struts [m]
 *  @param thickness of the struts [m]
 *  @param attenuation of the metal less that of what it displaces [1/m] */
std::vector<XRayWire> strutWires(const std::vector<std::vector<Eigen::Vector3d>>& lines, double thickness,
                                 double attenuation);

}  // namespace endovascular_sim::fluoroscopy
