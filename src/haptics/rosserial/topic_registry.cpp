#include "haptics/rosserial/topic_registry.h"

#include <algorithm>

namespace endovascular_sim::haptics
{

namespace
{

constexpr std::size_t kMaxRefused = 64;  // bounds the memory that a faulty device can occupy

bool isForce(PayloadFormat format)
{
  return format != PayloadFormat::kHapticSample && format != PayloadFormat::kJointState;
}

}  // namespace

std::size_t smallestFrame(PayloadFormat format)
{
  switch (format)
  {
    case PayloadFormat::kHapticSample:
      return HapticSample::kSize + kFrameOverhead;
    case PayloadFormat::kJointState:
      return JointState::kSmallestSize + kFrameOverhead;
    case PayloadFormat::kHapticForce:
      return HapticForce::kSize + kFrameOverhead;
    case PayloadFormat::kWrench:
      return Wrench::kSize + kFrameOverhead;
    case PayloadFormat::kWrenchStamped:
      return Wrench::kStampedSize + kFrameOverhead;
  }
  return 0;
}

std::string TopicRegistry::check(const TopicInfo& topic, bool device_publishes, std::optional<Channel>& channel) const
{
  if (topic.id < kFirstApplicationId)
    return "id " + std::to_string(topic.id) + " is reserved by the protocol; number topics from 100";
  const auto type =
      std::find_if(types_.begin(), types_.end(), [&topic](const TopicType& known) { return known.type == topic.type; });
  if (type == types_.end())
    return "type " + topic.type + " is not one that the host uses";
  if (isForce(type->format) == device_publishes)
    return topic.type + (device_publishes ? " is an input of the device, it must subscribe to it"
                                          : " is an output of the device, it must publish it");
  if (type->md5 != topic.md5)
    return "md5 of " + topic.type + " is " + topic.md5 + " on the device and " + type->md5 +
           " here; build the firmware with this version's message headers";
  const std::size_t needed = smallestFrame(type->format);
  if (topic.buffer_size < 0 || static_cast<std::size_t>(topic.buffer_size) < needed)
    return "buffer of " + std::to_string(topic.buffer_size) + " bytes is too small, a frame of " + topic.type +
           " needs " + std::to_string(needed);
  const std::optional<Channel>& taken = device_publishes ? samples_ : force_;
  if (taken && taken->topic.id != topic.id)
    return "topic " + taken->topic.name + " is already in use for this";
  channel = Channel{topic, type->format};
  return {};
}

std::string TopicRegistry::announce(const TopicInfo& topic, bool device_publishes)
{
  std::optional<Channel> channel;
  std::string reason = check(topic, device_publishes, channel);
  std::optional<Channel>& slot = device_publishes ? samples_ : force_;
  if (reason.empty())
  {
    slot = std::move(channel);
    refused_.erase(topic.id);
    return reason;
  }
  if (slot && slot->topic.id == topic.id)
    slot.reset();  // the device has re-announced this id as another topic
  refuse(topic, reason);
  return reason;
}

void TopicRegistry::refuse(const TopicInfo& topic, const std::string& reason)
{
  if (refused_.size() < kMaxRefused || isRefused(topic.id))
    refused_[topic.id] = RefusedTopic{topic, reason};
}

void TopicRegistry::clear()
{
  samples_.reset();
  force_.reset();
  refused_.clear();
}

}  // namespace endovascular_sim::haptics
