#pragma once

#include "geometry/triangle_mesh.h"
#include "intervention/balloon_load.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::intervention
{

/** Quantitative measures of a lesion, before or after its treatment. */
struct LesionReport
{
  double reference_diameter = 0.0;  ///< interpolated healthy diameter at the minimal lumen [m]
  double minimal_diameter = 0.0;    ///< minimal lumen diameter, of a circle of equal area [m]
  double stenosis = 0.0;            ///< diameter stenosis 1 − minimal/reference [1]
  bool stented = false;             ///< true if a stent is placed
  double coverage = 0.0;            ///< fraction of the lesion's length covered by the stent [1]
  double apposition = 0.0;          ///< fraction of the stent's surface within 0.1 mm of the wall [1]
  double placement_error = 0.0;     ///< offset of the stent's centre from the lesion's centre, positive distally [m]
};

/** Measures a lesion in the current mesh. The reference diameter is interpolated between the sections one reference
 *  diameter proximal and distal to the lesion (as in quantitative coronary angiography: J. H. C. Reiber et al., 1985).
 *  Residual stenosis can be negative.
 *  @param mesh current mesh of the wall
 *  @param centreline centreline on which the lesion was placed
 *  @param stent sleeve of the placed stent, or null */
LesionReport reportLesion(const geometry::TriangleMesh& mesh, const vessel::CentrelineTree& centreline,
                          const vessel::PlacedLesion& lesion, const RoundBody* stent = nullptr);

}  // namespace endovascular_sim::intervention
