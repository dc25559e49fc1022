#include "image/import/complete_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include "common/input_file.h"

namespace endovascular_sim::image
{
namespace
{

std::uint32_t littleEndian(const char* bytes)
{
  std::uint32_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

InputError incompleteFile(const std::string& file)
{
  return InputError(file, "", "holds fewer values than its header names, or cannot be read; export the images again");
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
    throw incompleteFile(file);
}

}  // namespace endovascular_sim::image
