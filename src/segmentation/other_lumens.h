#pragma once

#include <cstddef>
#include <vector>

#include "segmentation/lumen/open_stretch.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Lumens of all branches but one, with a margin of 0.5 mm. */
OtherLumen otherLumens(const std::vector<LumenBranch>& branches, std::size_t own);

}  // namespace endovascular_sim::segmentation
