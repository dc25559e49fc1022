#include "image/import/meta_header.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <system_error>

#include "common/error.h"
#include "image/import/complete_file.h"

namespace endovascular_sim::image
{
namespace
{

constexpr auto kDataFile = "ElementDataFile";
constexpr std::size_t kMostHeader = 1 << 22;  // bytes, with a list of files

std::string trimmed(const std::string& text)
{
  constexpr auto kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/** Length of a file [bytes]; 0 where it cannot be read. */
std::uint64_t lengthOf(const std::filesystem::path& file)
{
  std::error_code code;
  const std::uint64_t length = std::filesystem::file_size(file, code);
  return code ? 0 : length;
}

/** Names of a pattern such as "slices/s%02d.raw 0 19 1": first number, last number, step. */
std::vector<std::string> namesOf(const std::string& pattern, const std::string& file)
{
  std::smatch match;
  // MetaIO gives the pattern to printf, so it must hold one whole number and nothing else.
  if (!std::regex_match(pattern, match, std::regex(R"(([^%\s]*%0?\d?[diu][^%\s]*)((?:\s+\d{1,5}){3}))")))
    throw InputError(file, kDataFile, "is no pattern of file names; expected e.g. slice%03d.raw 1 100 1");
  std::istringstream numbers(match[2].str());
  int first = 0;
  int last = 0;
  int step = 1;
  numbers >> first >> last >> step;
  std::vector<std::string> names;
  for (int k = first; k <= last && step > 0; k += step)
  {
    std::array<char, 4096> name{};
    // NOLINTNEXTLINE(clang-diagnostic-format-nonliteral): checked above
    std::snprintf(name.data(), name.size(), match[1].str().c_str(), k);
    names.emplace_back(name.data());
  }
  return names;
}

/** Number of bytes that a compressed stream of zlib or gzip holds, at most @p most; 0 for a damaged one.
 *  @param packed_bytes length of the stream in the file */
std::uint64_t uncompressedBytes(std::ifstream& in, std::uint64_t packed_bytes, std::uint64_t most)
{
  std::vector<char> packed(1 << 16);
  std::vector<char> plain(1 << 18);
  z_stream stream{};
  if (inflateInit2(&stream, 47) != Z_OK)  // either format
    return 0;
  int state = Z_OK;
  std::uint64_t bytes = 0;
  while (state == Z_OK && bytes <= most && packed_bytes > 0)
  {
    in.read(packed.data(), static_cast<long>(std::min<std::uint64_t>(packed.size(), packed_bytes)));
    if (in.gcount() == 0)
      break;
    packed_bytes -= static_cast<std::uint64_t>(in.gcount());
    stream.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(in.gcount());
    while (state == Z_OK && stream.avail_in > 0)
    {
      stream.next_out = reinterpret_cast<Bytef*>(plain.data());
      stream.avail_out = static_cast<uInt>(plain.size());
      state = inflate(&stream, Z_NO_FLUSH);
      bytes += plain.size() - stream.avail_out;
    }
  }
  inflateEnd(&stream);
  return state == Z_STREAM_END || bytes > most ? bytes : 0;
}

}  // namespace

MetaHeader::MetaHeader(const std::string& file) : file_(file)
{
  std::string begin(kMostHeader, '\0');
  std::ifstream content(file, std::ios::binary);
  content.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(content.gcount()));
  std::istringstream in(begin);
  std::string line;
  while (!has(kDataFile) && std::getline(in, line))
  {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos)
      continue;
    fields_[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
    length_ = static_cast<std::uint64_t>(std::max<std::streamoff>(in.tellg(), 0));
  }
  if (value(kDataFile).compare(0, 4, "LIST") == 0)
    while (std::getline(in, line))
      if (!trimmed(line).empty())
        list_.push_back(trimmed(line));
}

void MetaHeader::requireReadable() const
{
  if (!has("NDims") || !has(kDataFile))
    return;
  const std::string text = value("NDims");
  if (text.size() != 1 || text[0] < '1' || text[0] > '9')
    throw InputError(file_, "NDims", "is '" + text + "'; must be 3; export the image again");
  const std::string unit = value("DistanceUnits");
  if (!unit.empty() && unit != "mm" && unit != "?")
    throw InputError(file_, "DistanceUnits", "are '" + unit + "'; export the image in millimetres");
}

std::string MetaHeader::value(const std::string& key) const
{
  const auto found = fields_.find(key);
  return found == fields_.end() ? "" : found->second;
}

bool MetaHeader::isTrue(const std::string& key) const
{
  const std::string text = value(key);
  return !text.empty() && (text[0] == 'T' || text[0] == 't' || text[0] == '1');
}

std::vector<std::string> MetaHeader::dataFiles(std::size_t slices) const
{
  const std::string name = value(kDataFile);
  if (name == "LOCAL" || name == "Local" || name == "local")
    return {std::filesystem::path(file_).filename().string()};
  std::vector<std::string> names{name};
  if (name.compare(0, 4, "LIST") == 0)
    names = list_;
  else if (name.find('%') != std::string::npos)
    names = namesOf(name, file_);
  else
    return names;
  if (names.size() != slices)
    throw InputError(file_, kDataFile,
                     "names " + std::to_string(names.size()) + " files for " + std::to_string(slices) +
                         " slices; give one file per slice");
  return names;
}

void MetaHeader::requireUncompressed(const std::string& file, std::uint64_t begin, std::uint64_t bytes) const
{
  std::uint64_t packed = std::strtoull(value("CompressedDataSize").c_str(), nullptr, 10);
  if (packed == 0 && begin > 0)
    throw InputError(file_, "CompressedDataSize", "is missing; export the image again, or without compression");
  if (packed == 0)
    packed = lengthOf(file);
  std::ifstream in(file, std::ios::binary);
  if (lengthOf(file) < begin + packed || !in.seekg(static_cast<std::streamoff>(begin)) ||
      uncompressedBytes(in, packed, bytes) < bytes)
    throw incompleteFile(file_);
}

void MetaHeader::requireWords(const std::string& file, std::uint64_t begin, std::uint64_t values) const
{
  std::ifstream in(file);
  in.seekg(static_cast<std::streamoff>(begin));
  std::uint64_t words = 0;
  for (std::string word; words < values && in >> word;)
    ++words;
  if (words < values)
    throw incompleteFile(file_);
}

void MetaHeader::requireComplete(std::uint64_t values, unsigned value_bytes, std::size_t slices) const
{
  const std::vector<std::string> names = dataFiles(slices);
  const std::filesystem::path path(file_);
  const std::uint64_t header = std::strtoull(value("HeaderSize").c_str(), nullptr, 10);
  for (const std::string& name : names)
  {
    const std::filesystem::path part = path.parent_path() / name;
    const std::uint64_t begin = part == path ? length_ : value("HeaderSize").compare(0, 1, "-") == 0 ? 0 : header;
    const std::uint64_t bytes = values * value_bytes / names.size();
    if (isTrue("CompressedData"))
      requireUncompressed(part, begin, bytes);
    else if (has("BinaryData") && !isTrue("BinaryData"))
      requireWords(part, begin, values / names.size());
    else if (lengthOf(part) < begin + bytes)
      throw incompleteFile(file_);
  }
}

}  // namespace endovascular_sim::image
