#pragma once

#include <string>

#include "geometry/triangle_mesh.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{

/** Wall with a thickness: a closed surface with an inner and an outer side that meet at the openings of the lumen. */
struct ThickWall
{
  double share = 0.0;      ///< share of the area that faces an enclosed lumen across the wall [1]
  double thickness = 0.0;  ///< median thickness there [m]
  double width = 0.0;      ///< median width of the enclosed lumen [m]

  bool found() const;
  /** Description with the remedy. */
  std::string text() const;
};

/** Looks for a wall with a thickness in a clean mesh. At points of such a wall's inner side the solid is a sheet; the
 *  next wall on the outer side is farther away than the sheet is thick; and the space between is enclosed. A ring of
 *  vessels is no sheet, a flat or C-shaped lumen encloses nothing, and a dissection's flap is thinner than its lumens.
 */
ThickWall findThickWall(const geometry::TriangleMesh& mesh, const MeshReport& report);

/** Requires that a clean mesh is the surface of a lumen, of the size of vessels that instruments enter.
 *  @param unit metres per unit with which the file was read
 *  @throws InputError for a lumen of another size, with the likely unit, and for a wall with a thickness */
void requireLumen(const geometry::TriangleMesh& mesh, double unit, const std::string& source);

}  // namespace endovascular_sim::vessel
