#pragma once

#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/projection/wire.h"
#include "fluoroscopy/projection/x_ray_instrument.h"

namespace endovascular_sim::fluoroscopy
{

/** Fluids along a centreline. */
struct LocalFluids
{
  DeviceDensity around;  ///< around the stack: blood with contrast medium, or tissue
  DeviceDensity lumen;   ///< in the lumens of hollow instruments, without one for each
};

/** X-ray model of coaxial instruments on one centreline: at each edge, the layers of all instruments that reach it. An
 *  instrument in the lumen of another one displaces the fluid of that lumen. Nodes are inserted where a cross section
 * changes.
 *  @param nodes centreline from proximal to distal [m]
 *  @param instruments one per instrument
 *  @param behind per instrument: arc length from its tip to the last node [m]
 *  @param fluids one per edge of the centreline, or one for all
 *  @param lumens fluid in the lumen of each instrument; empty: that of @p fluids */
XRayWire coaxialStack(const std::vector<Eigen::Vector3d>& nodes, const std::vector<XRayInstrument>& instruments,
                      const std::vector<double>& behind, const std::vector<LocalFluids>& fluids,
                      const std::vector<DeviceDensity>& lumens = {});

}  // namespace endovascular_sim::fluoroscopy
