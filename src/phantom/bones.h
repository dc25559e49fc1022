#pragma once

#include <vector>

#include "phantom/tissue.h"

namespace endovascular_sim::phantom
{

/** Adds the bones of the trunk for config/anatomies/plain.yaml: spine, ribs, sternum, pelvis, proximal femurs. Each
 * has a cortex of 1.5 to 2 mm around marrow. */
void addBones(std::vector<TissuePart>& parts);

}  // namespace endovascular_sim::phantom
