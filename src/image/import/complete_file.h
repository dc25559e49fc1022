#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace endovascular_sim::image
{

// Checks that image files hold all of their values. ITK replaces values that are missing at the end of a file by zeros
// or by the content of its memory, without an error. The throwing functions throw InputError.

/** Fields of the text header of a MetaImage; with the key "", the length of the header [bytes]. */
std::map<std::string, std::string> metaFields(const std::string& file);

/** @param bytes of all values */
void requireCompleteMeta(const std::string& file, std::uint64_t bytes);

/** NIfTI, also compressed by gzip.
 *  @param offset of the values in the file, before compression [bytes]
 *  @param bytes of all values */
void requireCompleteNifti(const std::string& file, std::uint64_t offset, std::uint64_t bytes);

/** DICOM file whose pixels are not compressed; decoders check the others. */
void requireCompleteDicom(const std::string& file);

}  // namespace endovascular_sim::image
