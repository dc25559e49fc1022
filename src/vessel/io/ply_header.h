#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace endovascular_sim::vessel
{

/** Scalar types of a PLY property. */
enum class PlyType
{
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64,
};

/** Size of a scalar [bytes]. */
std::size_t sizeOf(PlyType type);

/** Property of a PLY element: a scalar, or a list with its length in front. */
struct PlyProperty
{
  std::string name;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< type of the length of a list
  PlyType type = PlyType::kFloat32;      ///< type of the scalar, or of the items of a list
};

/** Element of a PLY file. */
struct PlyElement
{
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /** Least size of one record in a binary file [bytes]. */
  std::size_t leastSize() const;
};

/** Storage of the data of a PLY file. */
enum class PlyStorage
{
  kAscii,
  kLittleEndian,
  kBigEndian,
};

/** Header of a PLY file. */
struct PlyHeader
{
  PlyStorage storage = PlyStorage::kAscii;
  std::vector<PlyElement> elements;
  std::string_view data;      ///< everything after the header
  std::size_t data_line = 0;  ///< number of the header's last line
};

/** Parses the header.
 *  @param path names the file in errors
 *  @throws InputError for a malformed header, or counts that the size of the file excludes */
PlyHeader parsePlyHeader(std::string_view bytes, const std::string& path);

}  // namespace endovascular_sim::vessel
