#pragma once

#include <string>

#include "segmentation/lumen/click_check.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/path_check.h"

namespace endovascular_sim::segmentation
{

/** Path through all clicks of a branch.
 *
 *  Between two clicks it is the minimal path to which regions are closed that are wider than the lumen at these two
 * clicks. A path that is much longer than the straight line, leaves the lumen or crosses a wall may have been diverted
 * by a narrow click. The minimal path without closed regions then takes its place, if it is shorter, remains in the
 * lumen and crosses no wall. If the first path is only long, the second one must be shorter by a fifth.
 *  @param file of the clicks, in errors
 *  @throws InputError for clicks in two vessels, and a path that crosses a wall between two lumens (wall_crossing.h).
 *          Two clicks between the first and the last one, one on each side of such a place and at most 10 mm or 5 radii
 * apart, confirm that it is a narrow place. A click on a loop confirms the loop: the path that crosses its neck returns
 * at this click, and the path round the loop does not */
ClickPath branchPath(const Scan& scan, const CheckedBranch& branch, const std::string& file);

/** Radius of the widest part of a path that is longer than it is wide; 0 if there is none. A shorter wide part is the
 * parent at the ostium of a branch.
 *  @return [m] */
double widestRadius(const Scan& scan, const ClickPath& path, const CheckedBranch& branch);

}  // namespace endovascular_sim::segmentation
