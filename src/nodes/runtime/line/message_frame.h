#pragma once

#include <cstdint>
#include <vector>

#include <ros/serialization.h>

#include "nodes/runtime/checked_stream.h"

namespace endovascular_sim::nodes
{

/** Writes a message as a frame of a local line: the bytes that a topic would carry. */
template <typename Message>
void toFrame(const Message& message, std::vector<std::uint8_t>& frame)
{
  frame.resize(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(frame.data(), static_cast<std::uint32_t>(frame.size()));
  ros::serialization::serialize(stream, message);
}

/** Reads a message from a frame. @throws ros::Exception for damaged bytes */
template <typename Message>
void fromFrame(const std::uint8_t* frame, std::uint32_t size, Message& message)
{
  CheckedStream(frame, size).readAll(message);
}

}  // namespace endovascular_sim::nodes
