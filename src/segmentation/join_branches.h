#pragma once

#include "segmentation/segment_vessel.h"

namespace endovascular_sim::segmentation
{

/** Joins the branches to one tree. The widest branch is the root. A branch joins the nearest other one by the end that
 * is nearer; where that is its last click, the branch is reversed. Its path is extended by a minimal path into the
 * lumen of the parent, and its cross-sections are fitted again. Beyond 3 mm, the parent is that whose
 * lumen the path to the root meets first; beyond 12 mm, a warning tells it.
 *  @throws InputError for a branch that is farther than 30 mm from all others, or farther than 12 mm without a lumen
 * between them */
void joinBranches(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings, int threads,
                  Segmentation& segmentation);

}  // namespace endovascular_sim::segmentation
