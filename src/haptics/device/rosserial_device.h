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
  std::int32_t buffer_size = 256;  ///< announced buffer size of both directions [bytes]
  double time_period = 2.5;        ///< period of the time requests [s]
  double force_timeout = 0.1;      ///< age of the newest force at which the device's watchdog sets zero force [s]
};

/** Device side of the rosserial protocol, equivalent to a microcontroller with the original client library. */
class RosserialDevice
{
public:
  static constexpr std::uint16_t kSampleId = 125;
  static constexpr std::uint16_t kForceId = 100;

  explicit RosserialDevice(DeviceOptions options) : options_(std::move(options)) {}

  /** Handles bytes from the host.
   *  @return received forces, in order */
  std::vector<HapticForce> receive(const std::uint8_t* data, std::size_t size, double now);
  /** Runs the force watchdog and the periodic time request. */
  void tick(double now);
  /** Sends a sample in the format of the options, once the host has requested the topics. */
  void sendSample(const HapticSample& sample);
  void sendLog(std::uint8_t level, const std::string& text);
  /** Bytes for the host since the last call. */
  Bytes takeOutput();

  /** True after the host has requested the topics and answered the time request. */
  bool isSubscribed() const { return announced_ && time_known_; }
  /** Force rendered by the motors at present; zero after a timeout. */
  const HapticForce& renderedForce() const { return rendered_force_; }
  std::uint64_t watchdogTrips() const { return watchdog_trips_; }
  std::uint64_t stops() const { return stops_; }  ///< number of TX_STOP frames received
  const ParserCounters& parserCounters() const { return parser_.counters(); }

private:
  void announce(double now);
  void requestTime(double now);
  std::optional<HapticForce> handle(const Frame& frame, double now);
  void append(const Bytes& frame);

  DeviceOptions options_;
  FrameParser parser_;
  Bytes output_;
  bool announced_ = false;
  bool time_known_ = false;
  double time_requested_at_ = 0.0;
  HapticForce rendered_force_;
  bool force_seen_ = false;
  double force_at_ = 0.0;
  std::uint32_t sequence_ = 0;
  std::uint64_t watchdog_trips_ = 0;
  std::uint64_t stops_ = 0;
};

}  // namespace endovascular_sim::haptics
