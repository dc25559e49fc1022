#pragma once

#include <string>
#include <vector>

#include "common/progress.h"
#include "geometry/triangle_mesh.h"
#include "segmentation/clicks/click_set.h"
#include "segmentation/lumen/lumen_fit.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Result of a segmentation: a lumen per branch, in the grid frame of the scan. */
struct Segmentation
{
  std::vector<LumenBranch> branches;  ///< in the order of the clicks
  std::vector<std::string> warnings;
};

/** Segments every branch by its own clicks: minimal path, then cross-sections, whose rays are lengthened where they
 * have no edge (reachEdges()).
 *  @param threads 0: number of processors; the result does not depend on it
 *  @throws InputError for clicks that do not lie in a lumen, or in two vessels (click_check.h), for those that are no
 *  course along a branch (path_check.h), and for a lumen without edges (wider_lumen.h) */
Segmentation segmentBranches(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings, int threads,
                             const ProgressReport& progress = {});

}  // namespace endovascular_sim::segmentation
