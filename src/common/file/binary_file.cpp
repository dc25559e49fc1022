#include "common/file/binary_file.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "common/hash.h"
#include "common/output_file.h"

namespace endovascular_sim
{
namespace
{

struct CacheHeader
{
  std::array<char, 8> magic{'e', 'v', 's', 'c', 'a', 'c', 'h', '1'};
  std::uint64_t key = 0;
  std::uint64_t bytes = 0;
  std::uint64_t hash = 0;
};

static_assert(sizeof(CacheHeader) == 32);

std::uint64_t hashOf(const std::string& bytes)
{
  Hash64 hash;
  hash.add(bytes);
  return hash.value();
}

}  // namespace

void writeBinaryFile(const std::string& file, const std::vector<std::string_view>& parts)
{
  const std::string temporary = file + "." + std::to_string(getpid()) + ".part";
  std::ofstream out(temporary, std::ios::binary);
  if (!out)
    throw writeError(file);
  for (const std::string_view part : parts)
    out.write(part.data(), static_cast<std::streamsize>(part.size()));
  out.close();
  if (!out || std::rename(temporary.c_str(), file.c_str()) != 0)
  {
    const InputError error = writeError(file);
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw error;
  }
}

void writeCacheFile(const std::string& file, std::uint64_t key, const std::vector<std::string_view>& parts)
{
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), ignored);
  std::string bytes;
  for (const std::string_view part : parts)
    bytes += part;
  CacheHeader header;
  header.key = key;
  header.bytes = bytes.size();
  header.hash = hashOf(bytes);
  writeBinaryFile(file, {bytesOf(header), bytes});
}

std::optional<std::string> readCacheFile(const std::string& file, std::uint64_t key)
{
  std::ifstream in(file, std::ios::binary);
  CacheHeader header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != CacheHeader().magic ||
      header.key != key)
    return std::nullopt;
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(file, code);
  if (code || size - sizeof header != header.bytes)
    return std::nullopt;
  std::string bytes(header.bytes, '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    return std::nullopt;
  return hashOf(bytes) == header.hash ? std::optional<std::string>(std::move(bytes)) : std::nullopt;
}

}  // namespace endovascular_sim
