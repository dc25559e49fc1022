#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "haptics/rosserial/rosserial_messages.h"

namespace endovascular_sim::haptics
{

/** Payload formats that the host supports. */
enum class PayloadFormat
{
  kHapticSample,
  kJointState,
  kHapticForce,
  kWrench,
  kWrenchStamped,
};

/** Message type as compiled into the host. */
struct TopicType
{
  PayloadFormat format = PayloadFormat::kHapticSample;
  std::string type;  ///< e.g. "sensor_msgs/JointState"
  std::string md5;   ///< 32 hexadecimal digits
};

/** Size of the smallest frame of a format, framing included: lower bound of a device's buffer [bytes]. */
std::size_t smallestFrame(PayloadFormat format);

/** Refused topic with the reason. */
struct RefusedTopic
{
  TopicInfo topic;
  std::string reason;
};

/** Topics of the connected device: the channel of the samples, the channel of the force, and the refused topics. */
class TopicRegistry
{
public:
  struct Channel
  {
    TopicInfo topic;
    PayloadFormat format = PayloadFormat::kHapticSample;
  };

  explicit TopicRegistry(std::vector<TopicType> types) : types_(std::move(types)) {}

  /** Checks and registers an announced topic.
   *  @return reason of a refusal; empty if the topic is accepted */
  std::string announce(const TopicInfo& topic, bool device_publishes);
  /** Registers a topic as refused for the given reason. */
  void refuse(const TopicInfo& topic, const std::string& reason);
  void clear();

  const std::optional<Channel>& samples() const { return samples_; }
  const std::optional<Channel>& force() const { return force_; }
  /** Refused topics by topic id. */
  const std::map<std::uint16_t, RefusedTopic>& refused() const { return refused_; }
  bool isRefused(std::uint16_t id) const { return refused_.count(id) != 0; }

private:
  std::string check(const TopicInfo& topic, bool device_publishes, std::optional<Channel>& channel) const;

  std::vector<TopicType> types_;
  std::optional<Channel> samples_;
  std::optional<Channel> force_;
  std::map<std::uint16_t, RefusedTopic> refused_;
};

}  // namespace endovascular_sim::haptics
