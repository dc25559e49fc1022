#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drive/operating_state.h"
#include "haptics/rosserial/rosserial_protocol.h"

/** Messages of the serial line as plain structures. The decoders throw PayloadError. */
namespace endovascular_sim::haptics
{

/** rosserial_msgs/TopicInfo. */
struct TopicInfo
{
  std::uint16_t id = 0;
  std::string name;
  std::string type;  ///< e.g. "sensor_msgs/JointState"
  std::string md5;
  std::int32_t buffer_size = 0;  ///< size of the device's buffer for this direction [bytes]
};

/** Reading of a clock. The host answers time requests with wall-clock time, not with simulation time. */
struct WallTime
{
  std::uint32_t seconds = 0;      ///< full seconds since 1970 [s]
  std::uint32_t nanoseconds = 0;  ///< remainder [ns]
};

/** rosserial_msgs/Log. */
struct LogLine
{
  enum Level : std::uint8_t
  {
    kDebug = 0,
    kInfo = 1,
    kWarn = 2,
    kError = 3,
    kFatal = 4,
  };
  std::uint8_t level = kInfo;
  std::string text;
};

/** endovascular_sim/HapticSample. */
struct HapticSample
{
  static constexpr std::size_t kSize = 13;
  static constexpr std::uint8_t kEnabled = 1;      ///< the user's hand holds the instrument
  static constexpr std::uint8_t kFault = 2;        ///< the device reports a fault
  static constexpr std::uint8_t kEndOfScript = 4;  ///< a scripted operator has finished

  std::uint32_t time = 0;  ///< time on the device's clock [µs]
  float insertion = 0;     ///< insertion since the start of the device [m]
  float rotation = 0;      ///< rotation since the start of the device [rad]
  std::uint8_t flags = kEnabled;
};

/** State byte of HapticForce. */
using DeviceState = drive::OperatingState;

/** endovascular_sim/HapticForce. */
struct HapticForce
{
  static constexpr std::size_t kSize = 13;

  std::uint32_t sample_time = 0;  ///< device time of the newest sample that this force responds to [µs]
  float force = 0;                ///< force, positive against insertion [N]
  float torque = 0;               ///< torque, positive against rotation [N·m]
  DeviceState state = DeviceState::kDisabled;
};

/** sensor_msgs/JointState. */
struct JointState
{
  static constexpr std::size_t kSmallestSize = 48;  ///< size with two positions, no names and no frame [bytes]

  std::uint32_t sequence = 0;
  WallTime stamp;
  std::string frame;
  std::vector<std::string> names;
  std::vector<double> positions;
  std::vector<double> velocities;
  std::vector<double> efforts;
};

/** geometry_msgs/Wrench. The x axis is the axis of the wire, forward by REP-103. */
struct Wrench
{
  static constexpr std::size_t kSize = 48;
  static constexpr std::size_t kStampedSize = kSize + 16;  ///< size of WrenchStamped with an empty frame [bytes]

  std::array<double, 3> force = {};   ///< force [N]
  std::array<double, 3> torque = {};  ///< torque [N·m]
};

Bytes encode(const TopicInfo& info);
Bytes encode(const WallTime& time);
Bytes encode(const LogLine& line);
Bytes encode(const HapticSample& sample);
Bytes encode(const HapticForce& force);
Bytes encode(const JointState& state);
Bytes encode(const Wrench& wrench);
/** Encodes a WrenchStamped with an empty frame and sequence number 0. */
Bytes encodeStamped(const Wrench& wrench, const WallTime& stamp);

TopicInfo decodeTopicInfo(const Bytes& payload);
WallTime decodeTime(const Bytes& payload);
LogLine decodeLog(const Bytes& payload);
HapticSample decodeHapticSample(const Bytes& payload);
HapticForce decodeHapticForce(const Bytes& payload);
JointState decodeJointState(const Bytes& payload);
Wrench decodeWrench(const Bytes& payload);

}  // namespace endovascular_sim::haptics
