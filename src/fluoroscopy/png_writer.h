#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace endovascular_sim::fluoroscopy
{

/** Writes a grey image as PNG, 8 bits per pixel, rows from the top.
 *  @throws InputError when sizes do not fit or the file cannot be written */
void writePng(const std::string& file, int width, int height, const std::vector<std::uint8_t>& grey);

/** The same with 16 bits per pixel, marked as linear in intensity (gamma 1). */
void writePng(const std::string& file, int width, int height, const std::vector<std::uint16_t>& grey);

}  // namespace endovascular_sim::fluoroscopy
