#pragma once

#include <string>
#include <vector>

#include "vessel/model/lesion.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::vessel
{

/** Narrows a vessel: the share of the diameter lost along the lesion is ½ grade (1 + cos 2πx/length) about its middle
 *  (D. F. Young, "Effect of a time-dependent stenosis on flow through a tube", 1968). Sections of any shape shrink
 *  towards the centreline, or with eccentricity towards a point beside it. The wall within a lesion is meshed
 *  anew with facets of 1/24 of the narrowed circumference; the centreline, its radii and the vessel's list of lesions
 * follow.
 *
 *  @pre the vessel's mesh is clean and its centreline is there
 *  @param origin the scene's file, for errors
 *  @throws InputError for a branch that does not exist (naming those that do), a point outside of the lumen, a lesion
 * that reaches beyond its branch, an impossible grade, a place where the branch has no wall of its own (inside its
 * parent) */
void addLesions(Vessel& vessel, const std::vector<Lesion>& lesions, const std::string& origin);

}  // namespace endovascular_sim::vessel
