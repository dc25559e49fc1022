#pragma once

#include <string>
#include <vector>

#include "common/progress.h"
#include "vessel/model/lesion.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::vessel
{

/** Adds stenoses to a vessel. The relative loss of diameter at distance x from the throat is
 *  ½·grade·(1 + cos 2πx/length) (D. F. Young, "Effect of a time-dependent stenosis on flow through a tube", 1968).
 *  Cross-sections of any shape shrink towards the centreline, or towards a point beside it for an eccentric lesion. The
 *  wall within a lesion is remeshed with an edge length of 1/24 of the narrowed circumference. Centreline, radii and
 *  the vessel's list of lesions are updated.
 *
 *  @pre the vessel's mesh is clean and its centreline is present
 *  @param origin file of the scene, for errors
 *  @throws InputError for an unknown branch, a point outside of the lumen, a lesion that extends beyond its branch, an
 *          invalid grade, or a location where the branch has no separate wall (inside its parent) */
void addLesions(Vessel& vessel, const std::vector<Lesion>& lesions, const std::string& origin,
                const ProgressReport& progress = {});

}  // namespace endovascular_sim::vessel
