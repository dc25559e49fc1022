#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <list>
#include <string>
#include <utility>
#include <vector>

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
  std::uint32_t size = 0;    ///< [B]
  std::uint64_t chunk = 0;   ///< position of its chunk in the file [B]
  std::uint32_t offset = 0;  ///< of its data in the decompressed chunk [B]

  /** Reports whether the message can be read as a type of this version: it has its fields, by present or former names,
   *  or the first ones of them. */
  template <typename Message>
  bool is() const
  {
    return isPresent<Message>() || hasFirstFields(definition, ros::message_traits::Definition<Message>::value());
  }

  /** Reads the message. Fields that a later version has appended keep their initial values.
   *  @pre is<Message>()
   *  @throws ros::Exception when the message ends too early or is too long */
  template <typename Message>
  boost::shared_ptr<Message> read() const
  {
    auto message = boost::make_shared<Message>();
    CheckedStream in(data, size);
    if (isPresent<Message>())
    {
      in.readAll(*message);
      return message;
    }
    try
    {
      in.next(*message);
    }
    catch (const ros::Exception&)
    {
      if (in.getLength() > 0)
        throw;  // it ends within a field, not between two
    }
    return message;
  }

private:
  template <typename Message>
  bool isPresent() const
  {
    return md5sum == ros::message_traits::MD5Sum<Message>::value() ||
           presentFields(definition) == presentFields(ros::message_traits::Definition<Message>::value());
  }
};

/** Calls a function for every message of a bag, in the order of the file. The index is not used: the function also
 * reads unclosed and truncated bags, up to the truncation. Damaged chunks are omitted.
 *
 *  Format: http://wiki.ros.org/Bags/Format/2.0
 *  @return description of the first damage; empty for a complete bag
 *  @throws InputError when the file cannot be read, is no bag, or is compressed with bzip2 */
std::string readBagMessages(const std::string& file, const std::function<void(const BagMessage&)>& visit);

/** Chunks of a bag by their positions, for messages that readBagMessages() has found. The newest ones are kept. */
class BagChunks
{
public:
  /** @throws InputError when the file cannot be read */
  explicit BagChunks(const std::string& file);

  /** Bytes of a message.
   *  @param chunk, offset, size as those of the message
   *  @return valid until the next call
   *  @throws InputError when the file has changed since the message was found */
  const std::uint8_t* data(std::uint64_t chunk, std::uint32_t offset, std::uint32_t size);

private:
  using Chunk = std::pair<std::uint64_t, std::vector<char>>;

  const std::vector<char>& chunkAt(std::uint64_t position);

  std::string file_;
  std::ifstream stream_;
  std::list<Chunk> kept_;  ///< decompressed, newest first
};

}  // namespace endovascular_sim::nodes
