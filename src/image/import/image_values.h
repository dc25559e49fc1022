#pragma once

#include <cstddef>
#include <map>
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

/** Voxels of one value, and those of them beside an equal one along i. */
struct Coherence
{
  std::size_t voxels = 0;
  std::size_t beside_equal = 0;
};

/** Coherence of each value, ascending; empty if one is no whole number, and for more values than label maps have. */
std::map<float, Coherence> coherenceOfLabels(const ImageValues& image);

/** Labels of a map without 0 for messages, e.g. "7, 52". */
std::string listedLabels(const std::map<float, Coherence>& labels);

/** Checks that the values are those of a CT or another image, and stores them in 16 bit.
 *  @param modality chosen by the user or named by the file; empty: a CT if it holds air
 *  @param volume receives modality, scale and values; its grid is set
 *  @throws InputError for values that are not finite or implausible, a label map, grey values of 8 bit as a CT,
 * Hounsfield units raised by 1024, and an unknown modality */
void storeValues(const ImageValues& image, std::optional<Modality> modality, const std::string& path, Volume& volume);

}  // namespace endovascular_sim::image
