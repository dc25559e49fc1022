#pragma once

#include <string>

#include "geometry/triangle_mesh.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{

/** Requires the longest side of the bounding box to be between 5 mm and 3 m.
 *  @param unit metres per unit with which the file was read
 *  @throws InputError naming @p source and the units with which it would be a vessel */
void requirePlausibleSize(const geometry::TriangleMesh& mesh, const MeshReport& report, double unit,
                          const std::string& source);

/** Requires a lumen between 1 mm and 120 mm wide, as instruments enter them.
 *  @param width width of the lumen (lumenWidth) [m]
 *  @throws InputError as requirePlausibleSize() */
void requirePlausibleWidth(double width, const MeshReport& report, double unit, const std::string& source);

/** Warning of a mesh that is so far from the origin that single precision is coarse there; empty if it is not. */
std::string distanceWarning(const MeshReport& report, const std::string& source);

}  // namespace endovascular_sim::vessel
