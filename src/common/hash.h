#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace endovascular_sim
{

/** 64-bit content hash over 8-byte words; a short last word is padded with zeros.
 *
 *  Multiply-xorshift chain: each word passes the finaliser of MurmurHash3. The hash depends on the order of the words
 *  and is equal on all little-endian machines. It is not cryptographic. */
class Hash64
{
public:
  /** Adds one 64-bit word. */
  void add(std::uint64_t word)
  {
    state_ = (state_ ^ word) * 0xff51afd7ed558ccdULL;
    state_ ^= state_ >> 33;
    state_ *= 0xc4ceb9fe1a85ec53ULL;
    state_ ^= state_ >> 29;
  }

  /** Adds the IEEE-754 bytes of a number. */
  void add(double value)
  {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof word);
    add(word);
  }

  /** Adds @p size bytes and then the size, so that shifting bytes between adjacent fields changes the hash. */
  void add(const void* data, std::size_t size)
  {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t))
    {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, size - i < sizeof word ? size - i : sizeof word);
      add(word);
    }
    add(static_cast<std::uint64_t>(size));
  }

  void add(const std::string& text) { add(text.data(), text.size()); }

  std::uint64_t value() const { return state_; }

  /** Continues from an earlier value(). */
  void resume(std::uint64_t value) { state_ = value; }

  /** Hash as 16 hexadecimal digits. */
  std::string hex() const { return toHex(state_); }

  static std::string toHex(std::uint64_t value)
  {
    static const char* digits = "0123456789abcdef";
    std::string text(16, '0');
    for (int i = 15; i >= 0; --i, value >>= 4)
      text[static_cast<std::size_t>(i)] = digits[value & 0xf];
    return text;
  }

private:
  std::uint64_t state_ = 0x9e3779b97f4a7c15ULL;
};

}  // namespace endovascular_sim
