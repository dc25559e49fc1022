#include "vessel/io/ply_reader.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "common/error.h"
#include "vessel/io/ply_header.h"
#include "vessel/io/text_cursor.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Values of a PLY file's data in their order. */
class PlyValues
{
public:
  PlyValues(const PlyHeader& header, const std::string& path)
    : storage_(header.storage), path_(path), data_(header.data), text_(header.data), data_line_(header.data_line)
  {
  }

  /** Begins a record; records of an ASCII file are lines. */
  void beginRecord(const std::string& element)
  {
    element_ = element;
    if (storage_ != PlyStorage::kAscii)
      return;
    do
    {
      if (!text_.nextLine())
        truncated();
      pending_ = text_.word();
    } while (pending_.empty());
  }

  /** Ends a record.
   *  @throws InputError for further values on the line of an ASCII file */
  void endRecord()
  {
    if (storage_ == PlyStorage::kAscii && (!pending_.empty() || !text_.word().empty()))
      malformed("has more values than the header announces; the file is damaged");
  }

  /** @throws InputError for data after the last element */
  void end()
  {
    const bool more = storage_ == PlyStorage::kAscii
                          ? text_.restOfText().find_first_not_of(" \t\r\n\v\f") != std::string_view::npos
                          : data_.size() > kMaxRest;
    if (more)
      throw InputError(path_, "", "has more data than its header announces; the file is damaged");
  }

  std::size_t rest() const { return storage_ == PlyStorage::kAscii ? text_.restOfText().size() : data_.size(); }

  double next(PlyType type) { return storage_ == PlyStorage::kAscii ? nextWord() : nextBinary(type); }

  /** Number of items of a list, at most as many as the data can hold. */
  std::size_t nextCount(const PlyProperty& list)
  {
    const double count = next(list.count_type);
    if (!(count >= 0.0) || count != std::floor(count))
      malformed("a list needs a length that is an integer from 0");
    if (storage_ != PlyStorage::kAscii &&
        count * static_cast<double>(sizeOf(list.type)) > static_cast<double>(data_.size()))
      truncated();
    if (count > static_cast<double>(std::numeric_limits<std::uint32_t>::max()))
      malformed("a list is too long");
    return static_cast<std::size_t>(count);
  }

  std::size_t line() const { return storage_ == PlyStorage::kAscii ? data_line_ + text_.lineNumber() : 0; }

  [[noreturn]] void malformed(const std::string& reason) const
  {
    const std::string at = storage_ == PlyStorage::kAscii ? ", line " + std::to_string(line()) : "";
    throw InputError(path_, "element " + element_ + at, reason);
  }

private:
  static constexpr std::size_t kMaxRest = 2;  ///< a line end that some programs add to binary data

  [[noreturn]] void truncated() const { malformed("the data end before the header's counts; the file is truncated"); }

  double nextWord()
  {
    const std::string_view word = pending_.empty() ? text_.word() : pending_;
    pending_ = {};
    double value = 0.0;
    if (!parseNumber(word, value))
      malformed(word.empty() ? "has fewer values than the header announces"
                             : "'" + std::string(word.substr(0, 20)) + "' is not a number");
    return value;
  }

  double nextBinary(PlyType type)
  {
    const std::size_t size = sizeOf(type);
    if (data_.size() < size)
      truncated();
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < size; ++k)
    {
      const std::size_t byte = storage_ == PlyStorage::kLittleEndian ? k : size - 1 - k;
      bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(data_[byte])) << (8 * k);
    }
    data_.remove_prefix(size);
    return valueOf(bits, type);
  }

  static double valueOf(std::uint64_t bits, PlyType type)
  {
    switch (type)
    {
      case PlyType::kInt8:
        return static_cast<std::int8_t>(bits);
      case PlyType::kUint8:
        return static_cast<std::uint8_t>(bits);
      case PlyType::kInt16:
        return static_cast<std::int16_t>(bits);
      case PlyType::kUint16:
        return static_cast<std::uint16_t>(bits);
      case PlyType::kInt32:
        return static_cast<std::int32_t>(bits);
      case PlyType::kUint32:
        return static_cast<std::uint32_t>(bits);
      case PlyType::kFloat32:
      {
        const auto low = static_cast<std::uint32_t>(bits);
        float value = 0.0F;
        std::memcpy(&value, &low, sizeof value);
        return value;
      }
      case PlyType::kFloat64:
        break;
    }
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  PlyStorage storage_;
  const std::string& path_;
  std::string_view data_;
  TextCursor text_;
  std::size_t data_line_;
  std::string element_;
  std::string_view pending_;  ///< first word of an ASCII record
};

/** Coordinate of a property's name: 0 x, 1 y, 2 z, −1 none. */
int coordinateOf(const PlyProperty& property)
{
  if (property.is_list || property.name.size() != 1)
    return -1;
  const char name = property.name[0];
  return name >= 'x' && name <= 'z' ? name - 'x' : -1;
}

bool isCorners(const PlyProperty& property)
{
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

void skip(const PlyProperty& property, PlyValues& values)
{
  const std::size_t count = property.is_list ? values.nextCount(property) : 1;
  for (std::size_t k = 0; k < count; ++k)
    values.next(property.type);
}

void readVertices(const PlyElement& element, PlyValues& values, MeshBuilder& mesh)
{
  for (std::size_t v = 0; v < element.count; ++v)
  {
    values.beginRecord(element.name);
    Eigen::Vector3d position = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    for (const PlyProperty& property : element.properties)
      if (const int k = coordinateOf(property); k >= 0)
        position[k] = values.next(property.type);
      else
        skip(property, values);
    values.endRecord();
    mesh.addVertex(position, values.line());
    mesh.reportRest(values.rest());
  }
}

void readFaces(const PlyElement& element, PlyValues& values, MeshBuilder& mesh)
{
  std::vector<long long> corners;
  for (std::size_t f = 0; f < element.count; ++f)
  {
    values.beginRecord(element.name);
    for (const PlyProperty& property : element.properties)
    {
      if (!isCorners(property))
      {
        skip(property, values);
        continue;
      }
      const std::size_t count = values.nextCount(property);
      if (count > MeshBuilder::kMaxCorners)
        values.malformed("a face has " + std::to_string(count) + " corners; export the mesh as triangles");
      corners.resize(count);
      for (long long& corner : corners)
      {
        const double number = values.next(property.type);
        if (!(std::abs(number) < 9e15) || number != std::floor(number))
          values.malformed("a vertex number is not an integer");
        corner = static_cast<long long>(number);
      }
      mesh.addFace(corners, values.line());
    }
    values.endRecord();
    mesh.reportRest(values.rest());
  }
}

void skipElement(const PlyElement& element, PlyValues& values)
{
  for (std::size_t k = 0; k < element.count; ++k)
  {
    values.beginRecord(element.name);
    for (const PlyProperty& property : element.properties)
      skip(property, values);
    values.endRecord();
  }
}

void requireCoordinates(const PlyElement& element, const std::string& path)
{
  bool found[3] = {false, false, false};
  for (const PlyProperty& property : element.properties)
    if (const int k = coordinateOf(property); k >= 0)
      found[k] = true;
  if (!found[0] || !found[1] || !found[2])
    throw InputError(path, "element vertex", "needs the properties x, y and z");
}

}  // namespace

void readPly(std::string_view bytes, const std::string& path, MeshBuilder& mesh)
{
  const PlyHeader header = parsePlyHeader(bytes, path);
  mesh.readSpace(bytes.substr(0, bytes.size() - header.data.size()));
  PlyValues values(header, path);
  for (const PlyElement& element : header.elements)
  {
    // A record without properties has no data: its count alone must not cost time.
    if (element.properties.empty())
      continue;
    if (element.name == "vertex")
    {
      requireCoordinates(element, path);
      readVertices(element, values, mesh);
    }
    else if (element.name == "face")
      readFaces(element, values, mesh);
    else
      skipElement(element, values);
  }
  values.end();
}

}  // namespace endovascular_sim::vessel
