#include "vessel/io/ply_header.h"

#include <algorithm>
#include <map>

#include "common/error.h"
#include "vessel/io/text_cursor.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kMaxProperties = 256;  // of an element

[[noreturn]] void refuse(const std::string& path, std::size_t line, const std::string& reason)
{
  throw InputError(path, "header, line " + std::to_string(line), reason);
}

PlyType typeOf(std::string_view word, const std::string& path, std::size_t line)
{
  static const std::map<std::string_view, PlyType> kTypes{
      {"char", PlyType::kInt8},      {"int8", PlyType::kInt8},       {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},    {"short", PlyType::kInt16},     {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},  {"uint16", PlyType::kUint16},   {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},    {"uint", PlyType::kUint32},     {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat32},  {"float32", PlyType::kFloat32}, {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64}};
  const auto found = kTypes.find(word);
  if (found == kTypes.end())
    refuse(path, line, "unknown type '" + std::string(word.substr(0, 20)) + "' of a property");
  return found->second;
}

PlyStorage storageOf(std::string_view word, const std::string& path, std::size_t line)
{
  if (word == "ascii")
    return PlyStorage::kAscii;
  if (word == "binary_little_endian")
    return PlyStorage::kLittleEndian;
  if (word == "binary_big_endian")
    return PlyStorage::kBigEndian;
  refuse(path, line, "unknown format; a PLY file is ascii, binary_little_endian or binary_big_endian");
}

PlyProperty readProperty(TextCursor& text, const std::string& path)
{
  PlyProperty property;
  std::string_view word = text.word();
  property.is_list = word == "list";
  if (property.is_list)
  {
    property.count_type = typeOf(text.word(), path, text.lineNumber());
    if (property.count_type == PlyType::kFloat32 || property.count_type == PlyType::kFloat64)
      refuse(path, text.lineNumber(), "the length of a list must be of an integer type");
    word = text.word();
  }
  property.type = typeOf(word, path, text.lineNumber());
  property.name = text.word();
  return property;
}

/** Refuses counts that cannot fit into the data: memory is allocated by what a file holds, not by what it announces. */
void requireDataFor(const PlyHeader& header, const std::string& path)
{
  for (const PlyElement& element : header.elements)
  {
    const std::size_t least = header.storage == PlyStorage::kAscii ? 1 : std::max<std::size_t>(1, element.leastSize());
    if (element.count > header.data.size() / least)
      throw InputError(path, "element " + element.name,
                       "the header announces " + std::to_string(element.count) +
                           ", more than the file holds; it is truncated or damaged");
  }
}

}  // namespace

std::size_t sizeOf(PlyType type)
{
  switch (type)
  {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      break;
  }
  return 8;
}

std::size_t PlyElement::leastSize() const
{
  std::size_t size = 0;
  for (const PlyProperty& property : properties)
    size += sizeOf(property.is_list ? property.count_type : property.type);
  return size;
}

PlyHeader parsePlyHeader(std::string_view bytes, const std::string& path)
{
  TextCursor text(withoutByteOrderMark(bytes));
  PlyHeader header;
  if (!text.nextLine() || text.word() != "ply")
    throw InputError(path, "", "cannot be read as a mesh: a PLY file begins with the line 'ply'");
  bool has_format = false;
  while (true)
  {
    if (!text.nextLine())
      throw InputError(path, "header", "has no end_header; the file is truncated or damaged");
    const std::string_view keyword = text.word();
    const std::size_t line = text.lineNumber();
    if (keyword == "end_header")
      break;
    if (keyword == "format")
    {
      header.storage = storageOf(text.word(), path, line);
      has_format = true;
    }
    else if (keyword == "element")
    {
      PlyElement element;
      element.name = text.word();
      if (!parseNumber(text.word(), element.count))
        refuse(path, line, "an element needs a name and a count");
      header.elements.push_back(element);
    }
    else if (keyword == "property")
    {
      if (header.elements.empty() || header.elements.back().properties.size() >= kMaxProperties)
        refuse(path, line, "a property without an element, or too many of them");
      header.elements.back().properties.push_back(readProperty(text, path));
    }
    else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty())
      refuse(path, line, "unknown keyword '" + std::string(keyword.substr(0, 20)) + "'");
  }
  if (!has_format)
    throw InputError(path, "header", "has no line 'format'; the file is damaged");
  header.data = text.restOfText();
  header.data_line = text.lineNumber();
  requireDataFor(header, path);
  return header;
}

}  // namespace endovascular_sim::vessel
