#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include "contact/contract/contact_set.h"
#include "endovascular_sim/ContactSet.h"

namespace endovascular_sim::nodes
{

/** Contact set with a header, equivalent to a ContactSet message. Serialization reads and writes the core's set
 *  directly, without a copy of its features (about a thousand around an inflated balloon). */
struct StampedContactSet
{
  std_msgs::Header header;
  contact::ContactSet set;
};

// The serialized layout of a feature equals its memory layout (test_contact_set_serializer.cpp compares the fields).
static_assert(sizeof(contact::Feature) == 2 * sizeof(std::int32_t) + 12 * sizeof(double) &&
                  std::is_standard_layout<contact::Feature>::value,
              "contact::Feature must order its members as ContactFeature.msg does, without padding");

}  // namespace endovascular_sim::nodes

namespace ros
{
namespace message_traits
{

template <>
struct IsMessage<endovascular_sim::nodes::StampedContactSet> : public TrueType
{
};

template <>
struct MD5Sum<endovascular_sim::nodes::StampedContactSet> : public MD5Sum<endovascular_sim::ContactSet>
{
  using MD5Sum<endovascular_sim::ContactSet>::value;
  static const char* value(const endovascular_sim::nodes::StampedContactSet& /*message*/) { return value(); }
};

template <>
struct DataType<endovascular_sim::nodes::StampedContactSet> : public DataType<endovascular_sim::ContactSet>
{
  using DataType<endovascular_sim::ContactSet>::value;
  static const char* value(const endovascular_sim::nodes::StampedContactSet& /*message*/) { return value(); }
};

template <>
struct Definition<endovascular_sim::nodes::StampedContactSet> : public Definition<endovascular_sim::ContactSet>
{
  using Definition<endovascular_sim::ContactSet>::value;
  static const char* value(const endovascular_sim::nodes::StampedContactSet& /*message*/) { return value(); }
};

}  // namespace message_traits

namespace serialization
{

/** roscpp's way to send a type that is not generated ("Adapting C++ types"). */
template <>
struct Serializer<endovascular_sim::nodes::StampedContactSet>
{
  using Message = endovascular_sim::nodes::StampedContactSet;
  using Feature = endovascular_sim::contact::Feature;

  template <typename Stream>
  static void write(Stream& stream, const Message& message)
  {
    const endovascular_sim::contact::ContactSet& set = message.set;
    stream.next(message.header);
    stream.next(set.step);
    stream.next(static_cast<std::uint16_t>(set.substep));
    stream.next(static_cast<std::uint16_t>(set.pass));
    stream.next(set.vessel_version);
    stream.next(static_cast<std::uint32_t>(set.first_edge));
    stream.next(set.free_distance);
    const auto bytes = static_cast<std::uint32_t>(set.features.size() * sizeof(Feature));
    stream.next(static_cast<std::uint32_t>(set.features.size()));
    if (bytes > 0)
      std::memcpy(stream.advance(bytes), static_cast<const void*>(set.features.data()), bytes);
  }

  template <typename Stream>
  static void read(Stream& stream, Message& message)
  {
    endovascular_sim::contact::ContactSet& set = message.set;
    std::uint16_t substep = 0;
    std::uint16_t pass = 0;
    std::uint32_t first_edge = 0;
    std::uint32_t features = 0;
    stream.next(message.header);
    stream.next(set.step);
    stream.next(substep);
    stream.next(pass);
    stream.next(set.vessel_version);
    stream.next(first_edge);
    stream.next(set.free_distance);
    stream.next(features);
    set.substep = substep;
    set.pass = pass;
    set.first_edge = static_cast<int>(first_edge);
    const std::uint64_t bytes = std::uint64_t{features} * sizeof(Feature);
    if (bytes > stream.getLength())
      throwStreamOverrun();
    set.features.resize(features);
    if (bytes > 0)
      std::memcpy(static_cast<void*>(set.features.data()), stream.advance(static_cast<std::uint32_t>(bytes)), bytes);
  }

  static std::uint32_t serializedLength(const Message& message)
  {
    const endovascular_sim::contact::ContactSet& set = message.set;
    const std::size_t numbers = sizeof(set.step) + 2 * sizeof(std::uint16_t) + sizeof(set.vessel_version) +
                                sizeof(std::uint32_t) + 2 * sizeof(std::uint32_t);
    return serializationLength(message.header) +
           static_cast<std::uint32_t>(numbers + set.free_distance.size() * sizeof(double) +
                                      set.features.size() * sizeof(Feature));
  }
};

}  // namespace serialization
}  // namespace ros
