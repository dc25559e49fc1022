#pragma once

#include <string>
#include <vector>

#include "segmentation/lumen/click_check.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/path_check.h"

namespace endovascular_sim::segmentation
{

/** Path through the clicks of a branch, checked (path_check.h). Clicks whose path returns are put into the order in
 * which they lie along the branch.
 *  @param branch receives the order of its clicks
 *  @param warnings receives an order that was changed
 *  @throws InputError as branchPath(), requireCourse() and requireDirect() */
ClickPath orderedPath(const Scan& scan, CheckedBranch& branch, bool is_alone, const std::string& file,
                      std::vector<std::string>& warnings);

}  // namespace endovascular_sim::segmentation
