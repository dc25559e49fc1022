#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "haptics/rosserial/rosserial_messages.h"

namespace endovascular_sim::haptics
{

/** Payloads that this host understands. */
enum class PayloadFormat
{
  kHapticSample,
  kJointState,
  kHapticForce,
  kWrench,
  kWrenchStamped,
};

/** A message type as the host was built with it. */
struct TopicType
{
  PayloadFormat format = PayloadFormat::kHapticSample;
  std::string type;  ///< e.g. "sensor_msgs/JointState"
  std::string md5;   ///< 32 hexadecimal digits
};

/** Bytes of the smallest frame of a format, framing included: what a device's buffer must hold at least. */
std::size_t smallestFrame(PayloadFormat format);

/** A topic that was turned down. */
struct RefusedTopic
{
  TopicInfo topic;
  std::string reason;
};

/** The topics of the connected device: which id carries the samples, which takes the force, and what was refused. */
class TopicRegistry
{
public:
  struct Channel
  {
    TopicInfo topic;
    PayloadFormat format = PayloadFormat::kHapticSample;
  };

  explicit TopicRegistry(std::vector<TopicType> types) : types_(std::move(types)) {}

  /** Takes an announcement. @return empty when it is accepted, else the reason why not */
  std::string announce(const TopicInfo& topic, bool device_publishes);
  /** Turns down an announcement for a reason found elsewhere. */
  void refuse(const TopicInfo& topic, const std::string& reason);
  void clear();

  const std::optional<Channel>& samples() const { return samples_; }
  const std::optional<Channel>& force() const { return force_; }
  /** Keyed by topic id. */
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
