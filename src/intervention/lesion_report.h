#pragma once

#include "geometry/triangle_mesh.h"
#include "intervention/vessel_opening.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::intervention
{

/** How a lesion looks, before or after its treatment. */
struct LesionReport
{
  double reference_diameter = 0.0;  ///< between the lumens before and behind the lesion, at its narrowest place [m]
  double least_diameter = 0.0;      ///< of circles with the sections' areas [m]
  double stenosis = 0.0;            ///< 1 − least/reference
  bool stented = false;
  double coverage = 0.0;         ///< share of the lesion's length inside of the stent [1]
  double apposition = 0.0;       ///< share of the stent's surface within 0.1 mm of the wall [1]
  double placement_error = 0.0;  ///< of the stent's middle from the lesion's, distal is positive [m]
};

/** Measures a lesion in a mesh as it is now. The reference is interpolated between the sections one reference diameter
 *  before and behind the lesion (as in quantitative angiography: J. H. C. Reiber et al., 1985), so residual stenosis
 *  can be negative.
 *  @param mesh of the wall now
 *  @param centreline in which the lesion was placed
 *  @param stent the placed sleeve, or null */
LesionReport reportLesion(const geometry::TriangleMesh& mesh, const vessel::CentrelineTree& centreline,
                          const vessel::PlacedLesion& lesion, const RoundBody* stent = nullptr);

}  // namespace endovascular_sim::intervention
