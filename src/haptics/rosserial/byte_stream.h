#pragma once

#include <cstdint>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "haptics/rosserial/rosserial_protocol.h"

/** ROS 1 serialisation: little-endian scalars; strings and arrays with a uint32 count in front. */
namespace endovascular_sim::haptics
{

/** Error: a payload does not match its message type. */
class PayloadError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** Writer of serialised scalars and strings. */
class ByteWriter
{
public:
  template <typename Scalar>
  void put(Scalar value)
  {
    static_assert(std::is_arithmetic_v<Scalar>, "scalars only");
    std::uint8_t raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    bytes_.insert(bytes_.end(), std::make_reverse_iterator(raw + sizeof value), std::make_reverse_iterator(raw));
#else
    bytes_.insert(bytes_.end(), raw, raw + sizeof value);
#endif
  }

  void putString(const std::string& text)
  {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }

  Bytes take()
  {
    return std::move(bytes_);
  }

private:
  Bytes bytes_;
};

/** Reader of serialised scalars and strings. Each read past the end throws PayloadError. */
class ByteReader
{
public:
  explicit ByteReader(const Bytes& bytes) : bytes_(bytes) {}

  template <typename Scalar>
  Scalar get()
  {
    static_assert(std::is_arithmetic_v<Scalar>, "scalars only");
    require(sizeof(Scalar));
    std::uint8_t raw[sizeof(Scalar)];
    for (std::size_t i = 0; i < sizeof raw; ++i)
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
      raw[sizeof raw - 1 - i] = bytes_[position_ + i];
#else
      raw[i] = bytes_[position_ + i];
#endif
    position_ += sizeof raw;
    Scalar value;
    std::memcpy(&value, raw, sizeof value);
    return value;
  }

  std::string getString()
  {
    const std::size_t size = get<std::uint32_t>();
    require(size);
    const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(position_);
    position_ += size;
    return {first, first + static_cast<std::ptrdiff_t>(size)};
  }

  /** Reads a uint32 count and checks it against the remaining bytes. */
  std::size_t getCount(std::size_t smallest_element)
  {
    const std::size_t count = get<std::uint32_t>();
    if (count > (bytes_.size() - position_) / smallest_element)
      throw PayloadError("an array announces " + std::to_string(count) + " elements, more than the payload holds");
    return count;
  }

  /** Throws PayloadError if bytes remain. */
  void finish() const
  {
    if (position_ != bytes_.size())
      throw PayloadError(std::to_string(bytes_.size() - position_) + " bytes after the end of the message");
  }

private:
  void require(std::size_t size) const
  {
    if (size > bytes_.size() - position_)
      throw PayloadError("payload of " + std::to_string(bytes_.size()) + " bytes ends inside a field");
  }

  const Bytes& bytes_;
  std::size_t position_ = 0;
};

}  // namespace endovascular_sim::haptics
