#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "haptics/force/force_output.h"
#include "haptics/force/force_shaper.h"
#include "haptics/force/motion_reference.h"
#include "haptics/rosserial/rosserial_messages.h"
#include "haptics/rosserial/rosserial_protocol.h"
#include "haptics/rosserial/topic_registry.h"
#include "haptics/serial/write_queue.h"

namespace endovascular_sim::haptics
{

/** Times after which the host stops trusting; all [s]. */
struct HostTiming
{
  double request_period = 0.5;     ///< between requests for topics while there are none
  double sample_doubt = 80e-3;     ///< age of the newest sample from which the force ramps down
  double sample_timeout = 100e-3;  ///< age from which the link is lost and the force is zero
  double force_doubt = 30e-3;      ///< silence of the simulation from which the force ramps down
  double force_timeout = 50e-3;    ///< silence from which the device is paused; the ramp has ended by then
  double fault_hold = 0.5;         ///< a fault stays at least this long
  double ramp_period = 5e-3;       ///< between force frames while the force moves without news
  double keep_alive = 20e-3;       ///< between force frames else
};

struct HostOptions
{
  std::vector<TopicType> types;
  ForceLimits limits;
  ShaperSettings shaping;
  HostTiming timing;
  HandMotion start;   ///< the command at the first sample
  double baud = 0.0;  ///< of the line, to pace the frames; 0: not paced [bit/s]
};

/** A command for the instrument, made from one sample of the device. */
struct MotionSample
{
  HandMotion command;
  std::uint32_t device_time = 0;  ///< [us]
};

struct HostCounters
{
  std::uint64_t samples = 0;          ///< that became motion or were held back by the device's flags
  std::uint64_t unknown_ids = 0;      ///< frames of a topic that was never announced
  std::uint64_t unused_frames = 0;    ///< frames of a refused topic or a service
  std::uint64_t malformed = 0;        ///< valid frames whose payload is not what its type says
  std::uint64_t topic_requests = 0;   ///< sent
  std::uint64_t times_answered = 0;   ///< clock requests of the device
  std::uint64_t forces_received = 0;  ///< from the simulation
  std::uint64_t forces_not_finite = 0;
  std::uint64_t links_lost = 0;  ///< samples stopped for longer than the timeout
};

/** The host's side of rosserial for one haptic device: bytes in, bytes out, time always an argument.
 *
 *  Times `now` are seconds of any clock that never steps back. Not thread-safe. */
class RosserialHost
{
public:
  explicit RosserialHost(HostOptions options);

  /** The line is open: asks the device for its topics. */
  void lineOpened(double now);
  /** The line is gone. @param reason is shown until the device is back */
  void lineClosed(const std::string& reason);

  /** Takes bytes from the line. @param wall answers the device's question for the time */
  void receive(const std::uint8_t* data, std::size_t size, double now, const WallTime& wall);
  /** Takes a new force from the simulation, computed for the motion @p caused_by. */
  void commandForce(const HandForce& force, const HandMotion& caused_by, double now);
  /** Watchdogs and everything that is due. To be called at wakeAt() or earlier. */
  void tick(double now, const WallTime& wall);
  /** When tick() has something to do [s]. */
  double wakeAt() const;
  /** Zero force and TX_STOP: the last words before the line is closed. */
  void shutDown(double now, const WallTime& wall);

  /** Motion and log lines since the last call. */
  std::vector<MotionSample> takeMotion();
  std::vector<LogLine> takeLog();

  WriteQueue& output() { return output_; }
  const WriteQueue& output() const { return output_; }
  DeviceState state() const { return state_; }
  /** Why it is in this state; empty when enabled. */
  const std::string& reason() const { return reason_; }
  /** What the device renders now. */
  const HandForce& renderedForce() const { return force_.value(); }
  /** What the passivity controllers see and do. */
  const ForceShaper& shaper() const { return shaper_; }
  const TopicRegistry& topics() const { return topics_; }
  const HostCounters& counters() const { return counters_; }
  const ParserCounters& parserCounters() const { return parser_.counters(); }
  const MotionReference& motion() const { return motion_; }

private:
  void handle(const Frame& frame, double now, const WallTime& wall);
  void handleAnnouncement(const Frame& frame);
  void handleApplication(const Frame& frame, double now);
  void handleSample(const HapticSample& sample, double now);
  void handleJointState(const JointState& state, double now);
  void takeSample(const HandMotion& count, std::uint32_t time, std::uint8_t flags, double now);

  bool isTrusted(double now) const;
  void requestTopics(double now);
  void updateState(double now);
  void forgetDeviceClock();
  /** The force as it is now, as a frame; the device must take force. */
  Bytes forceFrame(double now, const WallTime& wall);

  HostOptions options_;
  FrameParser parser_;
  TopicRegistry topics_;
  MotionReference motion_;
  SampleTimes sample_times_;
  ForceShaper shaper_;
  ForceOutput force_;
  WriteQueue output_;
  HostCounters counters_;

  bool open_ = false;
  bool linked_ = false;   ///< samples arrive
  bool trusted_ = false;  ///< isTrusted() at the last tick
  bool urgent_ = false;   ///< a force frame must go out now
  std::string closed_reason_ = "the line was not opened yet";
  DeviceState state_ = DeviceState::kDisabled;
  std::string reason_;
  std::uint8_t flags_ = 0;  ///< of the newest sample
  std::uint64_t samples_at_opening_ = 0;
  double sample_at_;      ///< arrival of the newest sample
  double force_at_;       ///< arrival of the newest force
  double not_finite_at_;  ///< arrival of the newest force that was not finite
  double request_at_;     ///< newest request for topics
  double sent_at_;        ///< newest force frame
  std::uint32_t answered_time_ = 0;
  std::vector<MotionSample> motion_out_;
  std::vector<LogLine> log_out_;
};

}  // namespace endovascular_sim::haptics
