#pragma once

#include <vector>

#include "phantom/tissue.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::phantom
{

/** Tissues around the vessels of an anatomy, without the vessels themselves. For config/anatomies/plain.yaml: trunk
 * with skin, lungs, bones, abdominal organs, the heart with its chambers, and veins beside the left coronary arteries.
 * Every other anatomy lies in fat. */
std::vector<TissuePart> bodyParts(const vessel::Anatomy& anatomy, const std::vector<vessel::AnatomyChain>& chains);

/** Calcified plaques: balls of 0.9 mm at the wall of the coronary arteries, every 17 mm. They extend outwards only; the
 *  lumen is not part of them. */
std::vector<TissuePart> calcifiedPlaques(const vessel::Anatomy& anatomy,
                                         const std::vector<vessel::AnatomyChain>& chains);

}  // namespace endovascular_sim::phantom
