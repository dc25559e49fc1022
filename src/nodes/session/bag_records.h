#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <ros/message_traits.h>
#include <ros/time.h>
#include <boost/make_shared.hpp>

#include "nodes/runtime/checked_stream.h"
#include "nodes/session/former_names.h"

namespace endovascular_sim::nodes
{

/** Serialised message of a bag. */
struct BagMessage
{
  std::string topic;           ///< present name, see presentTopic()
  std::string recorded_topic;  ///< name in the bag
  std::string type;            ///< e.g. "endovascular_sim/DriveApplied"
  std::string md5sum;          ///< hash of the message's definition
  std::string definition;      ///< as the bag holds it
  bool is_latched = false;
  ros::Time time;  ///< of the recording
  const std::uint8_t* data = nullptr;
  std::uint32_t size = 0;  ///< [B]

  /** Reports whether the message has the fields of a type of this version, by present or former names. */
  template <typename Message>
  bool is() const
  {
    return md5sum == ros::message_traits::MD5Sum<Message>::value() ||
           presentFields(definition) == presentFields(ros::message_traits::Definition<Message>::value());
  }

  /** @throws ros::Exception when the message ends too early or is too long */
  template <typename Message>
  boost::shared_ptr<Message> read() const
  {
    auto message = boost::make_shared<Message>();
    CheckedStream(data, size).readAll(*message);
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
