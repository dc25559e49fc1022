#pragma once

#include <string>
#include <vector>

#include "segmentation/clicks/click_set.h"
#include "segmentation/lumen/lumen_fit.h"
#include "segmentation/lumen/scan.h"

namespace endovascular_sim::segmentation
{

/** Clicks with one branch per end in place of the ends of a tree.
 *
 *  The trunk leads from the first click to the widest other end and has the name of the tree. Every further end gets a
 * branch NAME_N, N the number of its click, which begins where the path from the first click leaves the lumens that are
 * there already. Branches with clicks from one end to the other stay unchanged.
 *  @param warnings receives the names of new branches, and ends that lie on the way to others
 *  @throws InputError for clicks and paths as segmentBranches(), and for a name that another branch has */
ClickSet withBranchPerEnd(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings,
                          std::vector<std::string>& warnings);

}  // namespace endovascular_sim::segmentation
