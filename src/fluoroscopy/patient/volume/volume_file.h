#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fluoroscopy/patient/volume/density_volume.h"

namespace endovascular_sim::fluoroscopy
{

/** File of a density volume, extension `.evsvol`: a header of 192 bytes (magic and version, key, hash of the content,
 * grid), then the voxels as in DensityVolume::voxels(). All numbers are little-endian. It holds no name and no date of
 * a patient.
 *
 *  @param key number stored beside the volume, e.g. the hash of all inputs from which it was computed
 *  @throws InputError with the reason of the operating system; an older file of this name stays */
void writeVolume(const std::string& file, const DensityVolume& volume, std::uint64_t key = 0);

/** Reads a file of writeVolume(). Memory is allocated only after the size of the file has been compared with its
 * header.
 *  @throws InputError naming file and remedy for a missing, truncated or damaged file and for another version */
DensityVolume readVolume(const std::string& file);

/** Reads a cached volume; empty if the file is missing, damaged or stored under another key. */
std::optional<DensityVolume> readCachedVolume(const std::string& file, std::uint64_t key);

}  // namespace endovascular_sim::fluoroscopy
