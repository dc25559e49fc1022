#pragma once

#include <string>

#include "segmentation/lumen/edge_settings.h"
#include "segmentation/lumen/open_stretch.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Doubles the rays of stretches without edges (openStretches()) until they have edges: an aneurysm is wider than the
 *  lumen at the clicks lets expect. A side branch needs no longer rays to be told from it: the farther its rays end,
 * the smaller is its share of the circumference.
 *  @param largest_radius bound of the lumen's radius that the clicks give [m]; 0: eight times the first rays, at most
 *         80 mm
 *  @param file of the clicks, for errors
 *  @throws InputError for a stretch that remains without edges, or that becomes wider than an aneurysm */
void reachEdges(const Scan& scan, double largest_radius, const EdgeSettings& settings, const OtherLumen& other,
                const std::string& file, LumenBranch& branch);

}  // namespace endovascular_sim::segmentation
