#pragma once

#include <cstdint>
#include <optional>
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

/** Watchdog times and frame periods of the host, all in seconds. */
struct HostTiming
{
  double request_period = 0.5;     ///< period of topic requests while topics are missing
  double sample_ramp_age = 80e-3;  ///< age of the newest sample at which the force begins to ramp down
  double sample_timeout = 100e-3;  ///< age of the newest sample at which the link counts as lost and the force is zero
  double force_ramp_age = 30e-3;   ///< age of the newest force at which the force begins to ramp down
  double force_timeout = 50e-3;    ///< age of the newest force at which the device is paused, after the ramp has ended
  double fault_hold = 0.5;         ///< shortest duration of a fault
  double ramp_period = 5e-3;       ///< period of force frames during a ramp without new forces
  double keep_alive = 20e-3;       ///< period of force frames otherwise
};

struct HostOptions
{
  std::vector<TopicType> types;
  ForceLimits limits;
  ShaperSettings shaping;
  HostTiming timing;
  /** Command at the first sample; none: the position of the instrument, of the first force. Samples before that force
   *  cause no motion. */
  std::optional<HandMotion> start = HandMotion();
  double baud = 0.0;  ///< speed of the line, for pacing the frames [bit/s]; 0: no pacing
};

/** Command for the instrument from one sample of the device. */
struct MotionSample
{
  HandMotion command;
  std::uint32_t device_time = 0;  ///< time of the sample on the device's clock [µs]
};

struct HostCounters
{
  std::uint64_t samples = 0;            ///< samples received, including those withheld because of the device's flags
  std::uint64_t unknown_ids = 0;        ///< frames of a topic that was not announced
  std::uint64_t unused_frames = 0;      ///< frames of a rejected topic or of a service
  std::uint64_t malformed = 0;          ///< valid frames with a payload that does not match its type
  std::uint64_t topic_requests = 0;     ///< topic requests sent
  std::uint64_t times_answered = 0;     ///< time requests of the device answered
  std::uint64_t forces_received = 0;    ///< forces received from the simulation
  std::uint64_t forces_not_finite = 0;  ///< forces from the simulation that were not finite
  std::uint64_t links_lost = 0;         ///< number of times that samples were missing for longer than the timeout
};

/** Host side of the rosserial protocol for one haptic device: a state machine from bytes to bytes.
 *
 *  It reads no clock: times `now` are seconds of any monotonic clock. Not thread-safe. */
class RosserialHost
{
public:
  explicit RosserialHost(HostOptions options);

  /** Handles the opening of the line: requests the device's topics. */
  void lineOpened(double now);
  /** Handles the loss of the line.
   *  @param reason reported by reason() until the device is connected again */
  void lineClosed(const std::string& reason);

  /** Handles bytes from the line.
   *  @param wall reply to a time request of the device */
  void receive(const std::uint8_t* data, std::size_t size, double now, const WallTime& wall);
  /** Sets the force from the simulation, computed for the motion @p caused_by. */
  void commandForce(const HandForce& force, const HandMotion& caused_by, double now);
  /** Sets the state of the simulation. While it does not run, the force is released and the device is paused.
   *  @param reason reason of the standstill, shown to the user; empty: the simulation runs */
  void setSimulationState(const std::string& reason, double now);
  /** Runs the watchdogs and queues due frames; to be called at wakeAt() or earlier. */
  void tick(double now, const WallTime& wall);
  /** Time at which tick() is due [s]. */
  double wakeAt() const;
  /** Queues zero force and TX_STOP, the final frames before the line is closed. */
  void shutDown(double now, const WallTime& wall);

  /** Motion since the last call. */
  std::vector<MotionSample> takeMotion();
  /** Log lines of the device since the last call. */
  std::vector<LogLine> takeLog();

  WriteQueue& output() { return output_; }
  const WriteQueue& output() const { return output_; }
  DeviceState state() const { return state_; }
  /** Reason of the state; empty when enabled. */
  const std::string& reason() const { return reason_; }
  /** Force rendered by the device at present. */
  const HandForce& renderedForce() const { return force_.value(); }
  /** Force shaper with the reports of its passivity controllers. */
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
  void clearDeviceClock();
  /** Frame with the present force; the device must have subscribed to the force. */
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
  bool linked_ = false;            ///< samples arrive within the timeout
  bool trusted_ = false;           ///< isTrusted() at the last tick
  bool urgent_ = false;            ///< a force frame is due immediately
  bool is_placed_;                 ///< the command at the first sample is known
  std::string standstill_reason_;  ///< reason for which the simulation does not run; empty while it runs
  std::string closed_reason_ = "the line was not opened yet";
  DeviceState state_ = DeviceState::kDisabled;
  std::string reason_;
  std::uint8_t flags_ = 0;                ///< flags of the newest sample
  std::uint64_t samples_at_opening_ = 0;  ///< sample counter when the line was opened
  double sample_at_;                      ///< arrival time of the newest sample [s]
  double force_at_;                       ///< arrival time of the newest force [s]
  double not_finite_at_;                  ///< arrival time of the newest force that was not finite [s]
  double request_at_;                     ///< time of the newest topic request [s]
  double sent_at_;                        ///< time of the newest force frame [s]
  std::uint32_t answered_time_ = 0;       ///< device time of the sample that the newest force responds to [µs]
  std::vector<MotionSample> motion_out_;
  std::vector<LogLine> log_out_;
};

}  // namespace endovascular_sim::haptics
