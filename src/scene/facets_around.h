#pragma once

#include <string>

#include "contact/wall/wall_law.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::scene
{

/** Number of facets around the lumen. */
struct FacetsAround
{
  int fewest = 0;  ///< in nine tenths of the lumen there are more; 0: unknown
  int median = 0;

  /** Result as a line of text, with a remark where the facets disturb the force and the torque at the hand
   *  (docs/validation/facets_torque.csv). */
  std::string text(contact::WallShape wall) const;
};

/** Number of facets around the lumen, from the dihedral angles of the mesh: 2π divided by the dihedral angle across the
 *  direction of the lumen. No centreline is needed. Caps do not count. */
FacetsAround facetsAround(const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::scene
