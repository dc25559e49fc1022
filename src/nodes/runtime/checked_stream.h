#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace endovascular_sim::nodes
{

/** Input stream that checks the length of every array before it reserves memory: damaged bytes never exhaust it. */
class CheckedStream : public ros::serialization::IStream
{
public:
  CheckedStream(const std::uint8_t* data, std::uint32_t size)
    : IStream(const_cast<std::uint8_t*>(data), size)  // NOLINT: the base class only reads
  {
  }

  /** Skips bytes; where there are fewer, the position does not change.
   *  @throws ros::Exception then */
  std::uint8_t* advance(std::uint32_t size)
  {
    if (size > getLength())
      ros::serialization::throwStreamOverrun();
    return IStream::advance(size);
  }

  template <typename T>
  void next(T& value)
  {
    ros::serialization::deserialize(*this, value);
  }

  template <typename T, typename Allocator>
  void next(std::vector<T, Allocator>& values)
  {
    std::uint32_t count = 0;
    next(count);
    if (std::uint64_t{count} * smallestSize<T>() > getLength())
      ros::serialization::throwStreamOverrun();
    values.clear();
    values.resize(count);
    if constexpr (std::is_arithmetic_v<T>)
    {
      const auto bytes = static_cast<std::uint32_t>(count * sizeof(T));
      if (bytes > 0)
        std::memcpy(values.data(), advance(bytes), bytes);
    }
    else
      for (T& value : values)
        next(value);
  }

  /** Reads a complete message. @throws ros::Exception when it ends too early or is too long */
  template <typename Message>
  void readAll(Message& message)
  {
    next(message);
    if (getLength() > 0)
      ros::serialization::throwStreamOverrun();
  }

private:
  /** Smallest size of an element in the stream [B]. */
  template <typename T>
  static std::uint64_t smallestSize()
  {
    return ros::serialization::serializationLength(T());  // without any elements of its own arrays
  }
};

}  // namespace endovascular_sim::nodes
