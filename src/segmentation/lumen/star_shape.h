#pragma once

#include <optional>
#include <vector>

#include "segmentation/lumen/path_turns.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** True if rays graze a bulge of the contour, behind which a part of the lumen is hidden from the centre: the radius
 *  jumps down and up again at the two sides of the bulge. A side branch is no bulge: its rays are the long ones, and
 *  few. A bulge is a wall: most of its rays have an edge. */
bool hidesLumen(const Section& section);

/** First stretch of 3 mm or more whose contours hide a part of the lumen, such as the horns of a crescent. Only wide
 *  lumens are looked at. */
std::optional<Stretch> hiddenStretch(const LumenBranch& branch);

}  // namespace endovascular_sim::segmentation
