#include "vessel/io/vtk_values.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <map>

#include "common/error.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kMostExpansion = 1100;  // zlib's largest ratio is about 1032

[[noreturn]] void refuse(const std::string& path, const std::string& reason)
{
  throw InputError(path, "data array", reason);
}

std::uint64_t integer(std::string_view bytes, std::size_t size, bool big_endian)
{
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < size; ++k)
    bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[big_endian ? size - 1 - k : k])) << (8 * k);
  return bits;
}

/** Reads the lengths at the begin of blocks. */
class Lengths
{
public:
  Lengths(std::string_view data, const VtkBlocks& blocks, const std::string& path)
    : data_(data), blocks_(blocks), path_(path), size_(blocks.wide_headers ? 8 : 4)
  {
  }

  std::uint64_t at(std::size_t index) const
  {
    if (data_.size() / size_ <= index)
      refuse(path_, "ends before its lengths; the file is truncated");
    return integer(data_.substr(index * size_), size_, blocks_.big_endian);
  }

  std::size_t bytes(std::size_t count) const { return count * size_; }

private:
  std::string_view data_;
  const VtkBlocks& blocks_;
  const std::string& path_;
  std::size_t size_;
};

/** Bytes of the base64 text of @p count bytes, with its padding. */
std::size_t textSize(std::size_t count)
{
  return 4 * ((count + 2) / 3);
}

std::string decoded(std::string_view text, const std::string& path)
{
  std::string bytes;
  if (!decodeBase64(text, bytes))
    refuse(path, "has a character that is not of base64; the file is damaged");
  return bytes;
}

std::string plainBlock(std::string_view data, const VtkBlocks& blocks, std::size_t& budget, const std::string& path)
{
  const Lengths lengths(data, blocks, path);
  const std::uint64_t size = lengths.at(0);
  data.remove_prefix(lengths.bytes(1));
  if (size > data.size())
    refuse(path, "announces " + std::to_string(size) + " bytes, more than the file holds; the file is truncated");
  if (size > budget)
    refuse(path, "is too large; reduce the mesh");
  budget -= size;
  return std::string(data.substr(0, size));
}

/** Inflates the blocks of zlib.
 *  @param lengths number of blocks, size of a block, size of the last one (0: full), compressed size of each */
std::string inflated(const Lengths& lengths, std::string_view data, std::size_t& budget, const std::string& path)
{
  const std::uint64_t count = lengths.at(0);
  const std::uint64_t size = count > 0 ? lengths.at(1) : 0;
  const std::uint64_t last = count > 0 ? lengths.at(2) : 0;
  std::string bytes;
  for (std::uint64_t k = 0; k < count; ++k)
  {
    const std::uint64_t packed = lengths.at(3 + k);
    const std::uint64_t plain = k + 1 == count && last > 0 ? last : size;
    if (packed > data.size() || plain / kMostExpansion > packed)
      refuse(path, "has a compressed block that the file cannot hold; the file is damaged");
    if (plain > budget)
      refuse(path, "is too large; reduce the mesh");
    budget -= plain;
    const std::size_t begin = bytes.size();
    bytes.resize(begin + plain);
    uLongf made = static_cast<uLongf>(plain);
    if (uncompress(reinterpret_cast<Bytef*>(&bytes[begin]), &made, reinterpret_cast<const Bytef*>(data.data()),
                   static_cast<uLong>(packed)) != Z_OK ||
        made != plain)
      refuse(path, "has a compressed block that zlib cannot read; the file is damaged");
    data.remove_prefix(packed);
  }
  return bytes;
}

}  // namespace

bool parseVtkType(std::string_view name, VtkType& type)
{
  using Kind = VtkType::Kind;
  static const std::map<std::string, VtkType> kTypes{{"int8", {Kind::kSigned, 1}},
                                                     {"uint8", {Kind::kUnsigned, 1}},
                                                     {"int16", {Kind::kSigned, 2}},
                                                     {"uint16", {Kind::kUnsigned, 2}},
                                                     {"int32", {Kind::kSigned, 4}},
                                                     {"uint32", {Kind::kUnsigned, 4}},
                                                     {"int64", {Kind::kSigned, 8}},
                                                     {"uint64", {Kind::kUnsigned, 8}},
                                                     {"float32", {Kind::kFloat, 4}},
                                                     {"float64", {Kind::kFloat, 8}},
                                                     {"char", {Kind::kSigned, 1}},
                                                     {"signed_char", {Kind::kSigned, 1}},
                                                     {"unsigned_char", {Kind::kUnsigned, 1}},
                                                     {"short", {Kind::kSigned, 2}},
                                                     {"unsigned_short", {Kind::kUnsigned, 2}},
                                                     {"int", {Kind::kSigned, 4}},
                                                     {"unsigned_int", {Kind::kUnsigned, 4}},
                                                     {"long", {Kind::kSigned, 8}},
                                                     {"unsigned_long", {Kind::kUnsigned, 8}},
                                                     {"float", {Kind::kFloat, 4}},
                                                     {"double", {Kind::kFloat, 8}},
                                                     {"vtktypeint64", {Kind::kSigned, 8}},
                                                     {"vtktypeuint64", {Kind::kUnsigned, 8}},
                                                     {"vtkidtype", {Kind::kSigned, 4}}};
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = kTypes.find(lower);
  if (found != kTypes.end())
    type = found->second;
  return found != kTypes.end();
}

double vtkValue(std::string_view bytes, const VtkType& type, bool big_endian)
{
  const std::uint64_t bits = integer(bytes, type.size, big_endian);
  if (type.kind == VtkType::Kind::kUnsigned)
    return static_cast<double>(bits);
  if (type.kind == VtkType::Kind::kSigned)
  {
    const std::size_t shift = 64 - 8 * type.size;  // moves the sign to the highest bit
    return static_cast<double>(static_cast<std::int64_t>(bits << shift) >> shift);
  }
  if (type.size == 4)
  {
    const auto low = static_cast<std::uint32_t>(bits);
    float value = 0.0F;
    std::memcpy(&value, &low, sizeof value);
    return value;
  }
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::vector<double> vtkValues(std::string_view bytes, const VtkType& type, bool big_endian)
{
  std::vector<double> values;
  values.reserve(bytes.size() / type.size);
  for (std::size_t at = 0; at + type.size <= bytes.size(); at += type.size)
    values.push_back(vtkValue(bytes.substr(at, type.size), type, big_endian));
  return values;
}

bool decodeBase64(std::string_view text, std::string& bytes)
{
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text)
  {
    const auto u = static_cast<unsigned char>(c);
    if (std::isspace(u) != 0)
      continue;
    if (c == '=')
      return true;
    const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (digit < 0)
      return false;
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
    if (++count % 4 == 1)
      continue;
    bytes += static_cast<char>(bits >> (count % 4 == 2 ? 4U : count % 4 == 3 ? 2U : 0U) & 0xFFU);
  }
  return true;
}

std::string decodeVtkBlock(std::string_view data, const VtkBlocks& blocks, std::size_t& budget, const std::string& path)
{
  const std::size_t word = blocks.wide_headers ? 8 : 4;
  const std::string first = blocks.base64 ? decoded(data.substr(0, textSize(word)), path) : "";
  const std::uint64_t count = Lengths(blocks.base64 ? first : data, blocks, path).at(0);
  if (count > data.size())
    refuse(path, "announces more than the file holds; the file is truncated or damaged");
  if (!blocks.compressed)
    return blocks.base64 ? plainBlock(decoded(data.substr(0, textSize(word + count)), path), blocks, budget, path)
                         : plainBlock(data, blocks, budget, path);
  // In base64, the lengths of compressed blocks are a text of their own, with padding.
  const std::size_t header = (count == 0 ? 1 : 3 + count) * word;
  if (!blocks.base64)
    return inflated(Lengths(data, blocks, path), data.substr(std::min(header, data.size())), budget, path);
  const std::string lengths = decoded(data.substr(0, textSize(header)), path);
  const std::string packed = decoded(data.substr(std::min(textSize(header), data.size())), path);
  return inflated(Lengths(lengths, blocks, path), packed, budget, path);
}

}  // namespace endovascular_sim::vessel
