#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/volume.h"

namespace endovascular_sim::image
{

/** Choices of an import. */
struct ImportOptions
{
  int series = 0;                     ///< number of the series of a folder, from 1; 0: the only one
  std::optional<Modality> modality;   ///< empty: that of the file
  std::vector<long> labels;           ///< not empty: the images are a label map, of which these are read
  double subtract = 0.0;              ///< from all values
  std::uint64_t memory = 4ULL << 30;  ///< largest need [bytes]
};

/** Reads images of a patient: a folder with a DICOM series, or a file in NIfTI, NRRD or MetaImage. ITK reads all but
 * NIfTI; points in ITK are LPS, as in the patient frame. No name, number or date of a patient is taken over.
 *  @return values of the images; or of a label map the box around the chosen labels, as Modality::kLabels
 *  @throws InputError for a file that is none of these, a folder with several series, missing or implausible spacing or
 *          orientation, gantry tilt and missing slices, more than one value per voxel, label maps without a choice and
 * labels that they do not hold, values that are not finite, an unknown modality, a CT without the slope of its values,
 * with grey values of 8 bit or raised values, and a need beyond the limit of memory, which is known before the values
 * are read */
Volume readImages(const std::string& path, const ImportOptions& options);

}  // namespace endovascular_sim::image
