#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <boost/make_shared.hpp>

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

  template <typename T>
  void next(T& value)
  {
    ros::serialization::deserialize(*this, value);
  }

  template <typename T, typename Allocator>
  void next(std::vector<T, Allocator>& values)
  {
    std::uint32_t size = 0;
    next(size);
    if (size > getLength())  // every element takes at least one byte
      ros::serialization::throwStreamOverrun();
    values.clear();
    for (std::uint32_t k = 0; k < size; ++k)
    {
      values.emplace_back();
      next(values.back());
    }
  }
};

/** Serialised message of a bag. */
struct BagMessage
{
  std::string topic;
  std::string md5sum;  ///< hash of the message's definition
  const std::uint8_t* data = nullptr;
  std::uint32_t size = 0;  ///< [B]

  /** Reports whether the message has the fields of a type of this version. */
  template <typename Message>
  bool is() const
  {
    return md5sum == ros::message_traits::MD5Sum<Message>::value();
  }

  /** @throws ros::Exception when the message ends too early or is too long */
  template <typename Message>
  boost::shared_ptr<Message> read() const
  {
    auto message = boost::make_shared<Message>();
    CheckedStream stream(data, size);
    stream.next(*message);
    if (stream.getLength() > 0)
      ros::serialization::throwStreamOverrun();
    return message;
  }
};

/** Calls a function for every message of a bag, in the order of the file. The index is not used: the function also
 * reads unclosed and truncated bags, up to the truncation. Damaged chunks are omitted.
 *
 *  Format: http://wiki.ros.org/Bags/Format/2.0
 *  @return description of the first damage; empty for a complete bag
 *  @throws InputError when the file cannot be read, is no bag, or is compressed with bzip2 */
std::string readBagMessages(const std::string& file, const std::function<void(const BagMessage&)>& visit);

}  // namespace endovascular_sim::nodes
