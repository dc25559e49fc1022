#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace endovascular_sim::image
{

/** Text header of a MetaImage (.mha, .mhd), read as MetaIO reads it. */
class MetaHeader
{
public:
  explicit MetaHeader(const std::string& file);

  /** @return true for a field with this name */
  bool has(const std::string& key) const { return fields_.count(key) > 0; }

  /** Checks the number of dimensions, for which MetaIO takes memory unseen, and the unit, which ITK ignores.
   *  @throws InputError for a MetaImage with an implausible number, or another unit than millimetres */
  void requireReadable() const;

  /** Checks that the files of the image hold all values: the file itself, another one, a list or a numbered pattern.
   *  @param values number of them
   *  @param value_bytes bytes of a value
   *  @param slices number of files of a list or a pattern
   *  @throws InputError */
  void requireComplete(std::uint64_t values, unsigned value_bytes, std::size_t slices) const;

private:
  std::string value(const std::string& key) const;
  bool isTrue(const std::string& key) const;
  std::vector<std::string> dataFiles(std::size_t slices) const;
  void requireUncompressed(const std::string& file, std::uint64_t begin, std::uint64_t bytes) const;
  void requireWords(const std::string& file, std::uint64_t begin, std::uint64_t values) const;

  std::string file_;
  std::map<std::string, std::string> fields_;
  std::vector<std::string> list_;  ///< lines after the header, of ElementDataFile = LIST
  std::uint64_t length_ = 0;       ///< of the header [bytes]
};

}  // namespace endovascular_sim::image
