#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace endovascular_sim::test
{

/** Generator of damaged copies of a file's content. Equal seeds and inputs give equal copies.
 *
 *  Kinds of damage: a changed bit, an overwritten byte, an overwritten integer (limits of its type, small and large
 *  counts), a removed, repeated or inserted range, an inserted text of the format, a truncation. */
class RandomDamage
{
public:
  /** @param texts texts that are inserted, e.g. numbers and delimiters of a text format
   *  @param longest_range length of the longest removed or repeated range [B] */
  explicit RandomDamage(std::uint32_t seed, std::vector<std::string> texts = {}, std::size_t longest_range = 40)
    : random_(seed), texts_(std::move(texts)), longest_range_(longest_range)
  {
  }

  /** Number from 0 to @p count - 1. */
  std::size_t index(std::size_t count) { return random_() % count; }

  /** Copy with up to @p most_changes changes. A copy may equal the original. */
  std::string of(std::string bytes, std::size_t most_changes = 6)
  {
    const std::size_t changes = 1 + index(most_changes);
    for (std::size_t k = 0; k < changes && !bytes.empty(); ++k)
      change(bytes);
    return bytes;
  }

private:
  void change(std::string& bytes)
  {
    const std::size_t at = index(bytes.size());
    const std::size_t length = index(longest_range_);
    switch (index(texts_.empty() ? 7 : 8))
    {
      case 0:
        bytes[at] = static_cast<char>(random_());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << index(8)));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(index(bytes.size()), length));
        break;
      case 4:
        bytes.insert(at, randomBytes(length));
        break;
      case 5:
        overwriteInteger(bytes, at);
        break;
      case 6:
        bytes.resize(at);
        break;
      default:
        bytes.insert(at, texts_[index(texts_.size())]);
    }
  }

  std::string randomBytes(std::size_t length)
  {
    std::string bytes(length, '\0');
    std::generate(bytes.begin(), bytes.end(), [this] { return static_cast<char>(random_()); });
    return bytes;
  }

  /** Overwrites an integer of 1, 2, 4 or 8 bytes, as far as the content reaches. */
  void overwriteInteger(std::string& bytes, std::size_t at)
  {
    static constexpr std::uint64_t kIntegers[] = {0,
                                                  1,
                                                  2,
                                                  0xff,
                                                  0x7fff,
                                                  0x8000,
                                                  0x7fffffff,
                                                  0x80000000,
                                                  0xffffffff,
                                                  0x100000000,
                                                  0x7fffffffffffffff,
                                                  0x8000000000000000,
                                                  0xffffffffffffffff};
    const std::uint64_t value = kIntegers[index(std::size(kIntegers))];
    const std::size_t width = std::min(std::size_t{1} << index(4), bytes.size() - at);
    std::memcpy(&bytes[at], &value, width);
  }

  std::mt19937 random_;
  std::vector<std::string> texts_;
  std::size_t longest_range_;
};

}  // namespace endovascular_sim::test
