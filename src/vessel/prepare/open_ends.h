#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"
#include "vessel/prepare/prepare_report.h"

namespace endovascular_sim::vessel
{

/** Selects ends of a vessel, each once, in the order of the tree.
 *  @param selectors "all", "largest", a count (that many of the widest), the name of a branch, or "x,y,z" [m] (the
 *         nearest end)
 *  @param source name of the mesh in errors
 *  @throws InputError listing the ends, if a selector matches none */
std::vector<CentrelineEnd> selectEnds(const CentrelineTree& tree, const std::vector<std::string>& selectors,
                                      const std::string& source);

/** Indices of the ends that match selectors, ascending.
 *  @param ends ends of the tree among which is selected
 *  @param option name of the option in errors
 *  @throws InputError listing the ends, if a selector matches none */
std::vector<std::size_t> matchingEnds(const CentrelineTree& tree, const std::vector<CentrelineEnd>& ends,
                                      const std::vector<std::string>& selectors, const std::string& option,
                                      const std::string& source);

/** Opens an end of a closed vessel by a cut normal to its centreline.
 *  @param cut_back distance from the tip to the cut, in radii of the lumen
 *  @param source name of the mesh in errors
 *  @throws InputError if the branch is too short, or the plane would remove more than the end */
Opening openEnd(geometry::TriangleMesh& mesh, const CentrelineTree& tree, const CentrelineEnd& end, double cut_back,
                const std::string& source);

}  // namespace endovascular_sim::vessel
