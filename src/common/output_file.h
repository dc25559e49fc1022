#pragma once

#include <string>

#include "common/error.h"

namespace endovascular_sim
{

/** Error of a file that cannot be written, with the reason of the operating system: `errno` of the failed operation. To
 *  be called directly after it. */
InputError writeError(const std::string& file);

/** Reason of the last failed operation on a file, e.g. "No space left on device"; from `errno`. */
std::string systemReason();

/** Creates a folder and its parents unless they exist.
 *  @throws InputError with the reason of the operating system */
void createFolder(const std::string& folder);

/** Writes a whole text file.
 *  @throws InputError with the reason of the operating system */
void writeTextFile(const std::string& file, const std::string& text);

}  // namespace endovascular_sim
