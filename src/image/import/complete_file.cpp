#include "image/import/complete_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <vector>

#include "common/error.h"
#include "common/input_file.h"

namespace endovascular_sim::image
{
namespace
{

InputError incomplete(const std::string& file)
{
  return InputError(file, "", "holds fewer values than its header names, or cannot be read; export the images again");
}

/** Length of a file [bytes]; 0 where it cannot be read. */
std::uint64_t lengthOf(const std::filesystem::path& file)
{
  std::error_code code;
  const std::uint64_t length = std::filesystem::file_size(file, code);
  return code ? 0 : length;
}

std::uint32_t littleEndian(const char* bytes)
{
  std::uint32_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

std::map<std::string, std::string> metaFields(const std::string& file)
{
  std::map<std::string, std::string> fields;
  std::ifstream in(file, std::ios::binary);
  for (std::string line; fields.count("ElementDataFile") == 0 && std::getline(in, line);)
  {
    std::istringstream words(line);
    std::string key;
    std::string equals;
    words >> key >> equals;
    words >> fields[key];
    fields[""] = std::to_string(in.tellg());
  }
  return fields;
}

void requireCompleteMeta(const std::string& file, std::uint64_t bytes)
{
  std::map<std::string, std::string> fields = metaFields(file);
  const bool is_local = fields["ElementDataFile"] == "LOCAL";
  const std::filesystem::path path(file);
  const std::uint64_t length = lengthOf(is_local ? path : path.parent_path() / fields["ElementDataFile"]);
  const std::uint64_t header = is_local ? std::strtoull(fields[""].c_str(), nullptr, 10) : 0;
  if (fields["CompressedData"] == "True")
    bytes = std::strtoull(fields["CompressedDataSize"].c_str(), nullptr, 10);
  if (length < header + bytes)
    throw incomplete(file);
}

void requireCompleteNifti(const std::string& file, std::uint64_t offset, std::uint64_t bytes)
{
  std::uint64_t length = lengthOf(file);
  std::uint64_t needed = offset + bytes;
  if (std::filesystem::path(file).extension() == ".gz")
  {
    // The last four bytes of a gzip file are the length before compression, modulo 2^32.
    std::ifstream in = openInputFile(file, "give a NIfTI file", std::ios::binary);
    std::array<char, 4> last{};
    if (length < 18 || !in.seekg(-4, std::ios::end) || !in.read(last.data(), last.size()))
      throw incomplete(file);
    length = littleEndian(last.data());
    needed &= 0xffffffffULL;
    if (length != needed)
      throw incomplete(file);
  }
  if (length < needed)
    throw incomplete(file);
}

void requireCompleteDicom(const std::string& file)
{
  constexpr std::uint32_t kEncapsulated = 0xffffffffU;
  const std::array<char, 4> tag = {'\xe0', '\x7f', '\x10', '\0'};  // PixelData, little endian
  std::ifstream in = openInputFile(file, "give a DICOM file", std::ios::binary);
  const std::vector<char> content((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto found = std::find_end(content.begin(), content.end(), tag.begin(), tag.end());
  const auto position = static_cast<std::size_t>(found - content.begin());
  if (found == content.end() || position + 12 > content.size())
    return;
  const bool is_explicit =
      content[position + 4] == 'O' && (content[position + 5] == 'W' || content[position + 5] == 'B');
  const std::size_t header = is_explicit ? 12 : 8;
  const std::uint32_t bytes = littleEndian(&content[position + header - 4]);
  if (bytes != kEncapsulated && position + header + bytes > content.size())
    throw incomplete(file);
}

}  // namespace endovascular_sim::image
