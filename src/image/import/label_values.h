#pragma once

#include <string>
#include <vector>

#include "image/import/image_values.h"
#include "image/volume.h"

namespace endovascular_sim::image
{

/** Stores the chosen labels of a label map as 1, 2, … in the order of the choice, and reduces the grid to the box
 * around them with a margin of three voxels. Label maps have whole numbers of any type, also as floating point numbers.
 *  @param volume receives modality, scale and values; its grid is set
 *  @throws InputError for values that are no whole numbers, for an image, and for a label that the map does not hold,
 * with those that it holds */
void storeLabels(const ImageValues& image, const std::vector<long>& labels, const std::string& path, Volume& volume);

}  // namespace endovascular_sim::image
