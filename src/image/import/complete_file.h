#pragma once

#include <cstdint>
#include <string>

#include "common/error.h"

namespace endovascular_sim::image
{

// Checks that image files hold all of their values. ITK replaces values that are missing at the end of a file by zeros
// or by the content of its memory, without an error.

/** Error of a file that lacks values. */
InputError incompleteFile(const std::string& file);

/** Checks a DICOM file whose pixels are not compressed; decoders check the others.
 *  @throws InputError */
void requireCompleteDicom(const std::string& file);

}  // namespace endovascular_sim::image
