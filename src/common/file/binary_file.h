#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace endovascular_sim
{

/** Bytes of a plain value, or of the elements of a vector. */
template <typename T>
std::string_view bytesOf(const T& value)
{
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
template <typename T>
std::string_view bytesOf(const std::vector<T>& values)
{
  return {reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size()};
}

/** Writes a file of consecutive parts by renaming a temporary one: an older file of this name stays until all is
 * written.
 *  @throws InputError with the reason of the operating system */
void writeBinaryFile(const std::string& file, const std::vector<std::string_view>& parts);

/** Writes an entry of a cache: a header of magic, key, number and hash of the bytes, then the bytes. The folder is
 *  created.
 *  @param key hash of all inputs from which the bytes were computed
 *  @throws InputError as writeBinaryFile() */
void writeCacheFile(const std::string& file, std::uint64_t key, const std::vector<std::string_view>& parts);

/** Bytes of an entry of a cache; empty if the file is missing, damaged or stored under another key. Memory is allocated
 *  only after the size of the file has been compared with its header. */
std::optional<std::string> readCacheFile(const std::string& file, std::uint64_t key);

}  // namespace endovascular_sim
