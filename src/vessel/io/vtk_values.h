#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace endovascular_sim::vessel
{

/** Type of the numbers of a VTK array. */
struct VtkType
{
  enum class Kind
  {
    kSigned,
    kUnsigned,
    kFloat,
  };
  Kind kind = Kind::kFloat;
  std::size_t size = 4;  ///< [bytes]
};

/** Type by its name in an XML or a legacy file, e.g. Float32, vtktypeint64, unsigned_char.
 *  @return false for an unknown name */
bool parseVtkType(std::string_view name, VtkType& type);

/** Number of a type at the begin of the bytes, which must be long enough. Integers above 2⁵³ lose digits. */
double vtkValue(std::string_view bytes, const VtkType& type, bool big_endian);

/** Numbers of an array of bytes; a rest that is shorter than a number is ignored. */
std::vector<double> vtkValues(std::string_view bytes, const VtkType& type, bool big_endian);

/** Bytes of a base64 text up to its first padding; blanks are skipped.
 *  @return false for a character that is not of base64 */
bool decodeBase64(std::string_view text, std::string& bytes);

/** Layout of the binary blocks of an XML file. */
struct VtkBlocks
{
  bool big_endian = false;
  bool wide_headers = false;  ///< 64-bit lengths, else 32-bit ones
  bool compressed = false;    ///< by zlib
  bool base64 = false;        ///< blocks are text
};

/** Bytes of the array that begins at the begin of @p data.
 *  @param budget bytes that may still be decoded; reduced by those of the array
 *  @param path names the file in errors
 *  @throws InputError for lengths that the data cannot hold, or a stream that zlib refuses */
std::string decodeVtkBlock(std::string_view data, const VtkBlocks& blocks, std::size_t& budget,
                           const std::string& path);

}  // namespace endovascular_sim::vessel
