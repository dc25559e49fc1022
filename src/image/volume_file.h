#pragma once

#include <string>

#include "image/volume.h"

namespace endovascular_sim::image
{

/** Writes a volume to a file of this package, by renaming a temporary file. The file holds the grid, the modality and
 *  the values, and nothing else: no name, number or date of a patient.
 *
 *  Little endian: `evsvol01`, sizes (3 × int32), modality (uint32), spacing, origin, axes by columns, scale (16 ×
 *  float64), hash of the values (uint64), values (int16).
 *  @throws InputError when it cannot be written */
void writeVolume(const std::string& file, const Volume& volume);

/** Reads a volume of writeVolume().
 *  @throws InputError for a missing, damaged or foreign file; nothing is allocated for a file whose length does not fit
 *          its header */
Volume readVolume(const std::string& file);

}  // namespace endovascular_sim::image
