#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptics/rosserial/rosserial_messages.h"
#include "haptics/rosserial/rosserial_protocol.h"
#include "haptics/rosserial/topic_registry.h"

namespace endovascular_sim::haptics
{

struct DeviceOptions
{
  TopicType sample{PayloadFormat::kHapticSample, "endovascular_sim/HapticSample", ""};
  TopicType force{PayloadFormat::kHapticForce, "endovascular_sim/HapticForce", ""};
  std::int32_t buffer_size = 256;  ///< announced, both directions [bytes]
  double time_period = 2.5;        ///< between questions for the time [s]
  double force_timeout = 0.1;      ///< silence from which the device renders no force [s]
};

/** The device's side of rosserial: what a microcontroller with the original client library says and does. */
class RosserialDevice
{
public:
  static constexpr std::uint16_t kSampleId = 125;
  static constexpr std::uint16_t kForceId = 100;

  explicit RosserialDevice(DeviceOptions options) : options_(std::move(options)) {}

  /** Takes bytes from the host. @return the forces among them, in order */
  std::vector<HapticForce> receive(const std::uint8_t* data, std::size_t size, double now);
  /** Own watchdog and the periodic question for the time. */
  void tick(double now);
  /** Sends a sample when the host has asked for the topics; a JointState device sends it as one. */
  void sendSample(const HapticSample& sample);
  void sendLog(std::uint8_t level, const std::string& text);
  /** Bytes for the host since the last call. */
  Bytes takeOutput();

  /** The host has asked for the topics and answered the question for the time. */
  bool isSubscribed() const { return announced_ && time_known_; }
  /** Force that the motors show now: zero after the watchdog. */
  const HapticForce& shown() const { return shown_; }
  std::uint64_t watchdogTrips() const { return watchdog_trips_; }
  std::uint64_t stops() const { return stops_; }  ///< TX_STOP received
  const ParserCounters& parserCounters() const { return parser_.counters(); }

private:
  void announce(double now);
  void askTime(double now);
  std::optional<HapticForce> handle(const Frame& frame, double now);
  void append(const Bytes& frame);

  DeviceOptions options_;
  FrameParser parser_;
  Bytes output_;
  bool announced_ = false;
  bool time_known_ = false;
  double time_asked_at_ = 0.0;
  HapticForce shown_;
  bool force_seen_ = false;
  double force_at_ = 0.0;
  std::uint32_t sequence_ = 0;
  std::uint64_t watchdog_trips_ = 0;
  std::uint64_t stops_ = 0;
};

}  // namespace endovascular_sim::haptics
