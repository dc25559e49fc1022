#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/beam/device_response.h"

namespace endovascular_sim::fluoroscopy
{

/** Cylindrical surface in the cross section of a wire. */
struct WireLayer
{
  double radius = 0.0;    ///< [m]
  DeviceDensity density;  ///< density inside of the surface minus the density outside
};

inline bool operator==(const WireLayer& a, const WireLayer& b)
{
  return a.radius == b.radius && a.density == b.density;
}

/** Cross section of a stack of coaxial instruments: the density at a radius is the sum over all layers of larger
 * radius, relative to the fluid around the stack. */
using WireProfile = std::vector<WireLayer>;

/** X-ray model of a stack of coaxial instruments: a chain of cylinders with mitre joints; edge j joins nodes j and j
 * + 1. Collinear edges of equal profile may be merged. */
struct XRayWire
{
  std::vector<Eigen::Vector3d> nodes;       ///< patient frame [m]
  std::vector<WireProfile> profiles;        ///< cross sections
  std::vector<std::uint32_t> edge_profile;  ///< per edge: index in profiles
};

/** Checks the sizes and numbers of a wire.
 *  @throws InputError naming the invalid entry */
void checkWire(const XRayWire& wire);

/** Appends an edge to a wire, with the last profile if it is equal.
 *  @pre the wire has a node */
void appendEdge(XRayWire& wire, const Eigen::Vector3d& end, const WireProfile& profile);

}  // namespace endovascular_sim::fluoroscopy
