#pragma once

#include <vector>

#include "segmentation/lumen/ray_edges.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Median radius of the edges in a window along the path; where no ray has an edge, that of the nearest section with
 *  edges [m].
 *  @param sections whose reach replaces a radius that no section has */
std::vector<double> medianRadii(const std::vector<Section>& sections, const RayTable& edges);

/** Removes edges that do not fit the median radius of their section: side branches, noise in the middle of the lumen.
 * In a wide lumen, an edge stays that fits its neighbours: an aneurysm on one side, the corner of a dissected lumen.
 *  @param radius of the lumen at every section [m] */
void dropOutliers(const std::vector<double>& radius, RayTable& edges);

/** Sets the contours: medians over neighbours in angle and along the path, which fill rays without an edge, and four
 *  Fourier harmonics, in narrow lumens those that the blur resolves. A wide lumen that these cannot follow, e.g. with
 * the corners of a dissection, has medians along the path only, and as many harmonics as rays.
 *  @param radius of the lumen at every section [m] */
void setContours(const std::vector<double>& radius, const RayTable& edges, std::vector<Section>& sections);

}  // namespace endovascular_sim::segmentation
