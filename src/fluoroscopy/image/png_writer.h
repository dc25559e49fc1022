#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace endovascular_sim::fluoroscopy
{

/** Writes a greyscale PNG with 8 bits per pixel, in row-major order from the top.
 *  @throws InputError if the sizes are inconsistent or the file cannot be written */
void writePng(const std::string& file, int width, int height, const std::vector<std::uint8_t>& grey);

/** Writes a greyscale PNG with 16 bits per pixel, tagged as linear in intensity (gamma 1).
 *  @throws InputError if the sizes are inconsistent or the file cannot be written */
void writePng(const std::string& file, int width, int height, const std::vector<std::uint16_t>& grey);

/** Writes a PNG in colour with 8 bits per channel (red, green, blue), in row-major order from the top.
 *  @throws InputError if the sizes are inconsistent or the file cannot be written */
void writeColourPng(const std::string& file, int width, int height, const std::vector<std::uint8_t>& colours);

}  // namespace endovascular_sim::fluoroscopy
