#pragma once

#include <string>
#include <vector>

#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Warnings of metal in a CT (3000 HU or more), whose streaks displace edges: one per branch with metal within 30 mm,
 * with the place of the metal and the nearest place of the branch. */
std::vector<std::string> metalWarnings(const Scan& scan, const std::vector<LumenBranch>& branches);

}  // namespace endovascular_sim::segmentation
