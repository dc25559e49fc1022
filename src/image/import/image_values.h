#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/volume.h"

namespace endovascular_sim::image
{

/** Values of an image as they were read, rescaled; i fastest. */
struct ImageValues
{
  std::vector<float> values;
  int columns = 1;     ///< number of voxels along i
  unsigned bits = 16;  ///< of a value in the file
};

/** Checks that the values are those of a CT or another image, and stores them in 16 bit.
 *  @param modality chosen by the user or named by the file; empty: a CT if it holds air
 *  @param volume receives modality, scale and values; its grid is set
 *  @throws InputError for values that are not finite or implausible, a label map, grey values of 8 bit as a CT,
 * Hounsfield units raised by 1024, and an unknown modality */
void storeValues(const ImageValues& image, std::optional<Modality> modality, const std::string& path, Volume& volume);

}  // namespace endovascular_sim::image
