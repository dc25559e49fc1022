#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/prepare/prepare_report.h"

namespace endovascular_sim::vessel
{

/** The ends that a list of wishes names, each once, in the order of the tree: "all", "largest", a count (that many of
 *  the widest), the name of a branch, or "x,y,z" [m] (the end nearest to it).
 *  @throws InputError with the ends that there are, when a wish names none */
std::vector<CentrelineEnd> chooseEnds(const CentrelineTree& tree, const std::vector<std::string>& wishes,
                                      const std::string& source);

/** Cuts a closed vessel across its centreline near the end, @p cut_back radii of the lumen before the tip.
 *  @throws InputError when the branch is too short, or the plane would cut off more than the end */
Opening openEnd(geometry::TriangleMesh& mesh, const CentrelineTree& tree, const CentrelineEnd& end, double cut_back,
                const std::string& source);

}  // namespace endovascular_sim::vessel
