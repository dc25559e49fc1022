#include "haptics/host/rosserial_host.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "haptics/rosserial/byte_stream.h"

namespace endovascular_sim::haptics
{

namespace
{

constexpr double kNever = -std::numeric_limits<double>::infinity();

std::string milliseconds(double seconds)
{
  return std::to_string(std::lround(seconds * 1e3)) + " ms";
}

/** Empty rosserial_msgs/RequestParamResponse: the host has no parameters for the device. */
Bytes emptyParameters()
{
  return Bytes(12, 0);
}

/** Index of a joint by name, or else @p fallback: joints under other names are in the order insertion, rotation. */
std::size_t jointIndex(const JointState& state, const char* name, std::size_t fallback)
{
  const auto found = std::find(state.names.begin(), state.names.end(), name);
  return found == state.names.end() ? fallback : static_cast<std::size_t>(found - state.names.begin());
}

}  // namespace

RosserialHost::RosserialHost(HostOptions options)
  : options_(std::move(options)),
    topics_(options_.types),
    motion_(options_.start.value_or(HandMotion())),
    shaper_(options_.shaping),
    force_(options_.limits),
    output_(options_.baud),
    is_placed_(options_.start.has_value()),
    sample_at_(kNever),
    force_at_(kNever),
    not_finite_at_(kNever),
    request_at_(kNever),
    sent_at_(kNever)
{
  updateState(0.0);
}

void RosserialHost::lineOpened(double now)
{
  open_ = true;
  parser_.reset();
  output_.clear();
  topics_.clear();
  samples_at_opening_ = counters_.samples;
  requestTopics(now);
  updateState(now);
}

void RosserialHost::lineClosed(const std::string& reason)
{
  open_ = linked_ = false;
  closed_reason_ = reason;
  sample_at_ = kNever;
  flags_ = 0;
  parser_.reset();
  output_.clear();
  topics_.clear();
  motion_.hold();
  shaper_.reset();
  force_.cut();
  clearDeviceClock();
  updateState(0.0);
}

void RosserialHost::receive(const std::uint8_t* data, std::size_t size, double now, const WallTime& wall)
{
  std::vector<Frame> frames;
  parser_.feed(data, size, frames);
  for (const Frame& frame : frames)
  {
    try
    {
      handle(frame, now, wall);
    }
    catch (const PayloadError&)
    {
      ++counters_.malformed;
    }
  }
}

void RosserialHost::handle(const Frame& frame, double now, const WallTime& wall)
{
  switch (frame.id)
  {
    case kPublisher:
    case kSubscriber:
      handleAnnouncement(frame);
      break;
    case kServiceServerPublisher:
    case kServiceServerSubscriber:
    case kServiceClientPublisher:
    case kServiceClientSubscriber:
      topics_.refuse(decodeTopicInfo(frame.payload), "services are not offered to the device");
      ++counters_.unused_frames;
      break;
    case kParameterRequest:
      output_.pushControl(encodeFrame(kParameterRequest, emptyParameters()));
      break;
    case kLog:
      log_out_.push_back(decodeLog(frame.payload));
      break;
    case kTime:
      output_.pushControl(encodeFrame(kTime, encode(wall)));
      ++counters_.times_answered;
      break;
    case kTxStop:
      topics_.clear();
      break;
    default:
      handleApplication(frame, now);
  }
}

void RosserialHost::handleAnnouncement(const Frame& frame)
{
  const TopicInfo topic = decodeTopicInfo(frame.payload);
  topics_.announce(topic, frame.id == kPublisher);
  urgent_ = true;
}

void RosserialHost::handleApplication(const Frame& frame, double now)
{
  const auto& samples = topics_.samples();
  if (samples && samples->topic.id == frame.id)
  {
    if (samples->format == PayloadFormat::kHapticSample)
      handleSample(decodeHapticSample(frame.payload), now);
    else
      handleJointState(decodeJointState(frame.payload), now);
  }
  else if (topics_.isRefused(frame.id))
  {
    ++counters_.unused_frames;
  }
  else
  {
    // The device was connected to an earlier host. It announces its topics on request only.
    ++counters_.unknown_ids;
    if (now >= request_at_ + options_.timing.request_period)
      requestTopics(now);
  }
}

void RosserialHost::handleSample(const HapticSample& sample, double now)
{
  takeSample({sample.insertion, sample.rotation}, sample.time, sample.flags, now);
}

void RosserialHost::handleJointState(const JointState& state, double now)
{
  const std::size_t insertion = jointIndex(state, "insertion", 0);
  const std::size_t rotation = jointIndex(state, "rotation", 1);
  if (insertion >= state.positions.size() || rotation >= state.positions.size())
    throw PayloadError("a joint state needs the positions of insertion and rotation");
  const auto time =
      static_cast<std::uint32_t>(std::uint64_t{state.stamp.seconds} * 1000000U + state.stamp.nanoseconds / 1000U);
  takeSample({state.positions[insertion], state.positions[rotation]}, time, HapticSample::kEnabled, now);
}

void RosserialHost::takeSample(const HandMotion& count, std::uint32_t time, std::uint8_t flags, double now)
{
  ++counters_.samples;
  sample_at_ = now;
  linked_ = true;
  flags_ = flags;
  const bool is_held = (flags & HapticSample::kEnabled) != 0 && (flags & HapticSample::kFault) == 0;
  if (!is_held || !is_placed_)
  {
    motion_.hold();
    shaper_.reset();
  }
  else if (const auto command = motion_.update(count))
  {
    shaper_.sample(*command, time, now);
    sample_times_.add(*command, time);
    motion_out_.push_back({*command, time});
  }
  if (!isTrusted(now))
    force_.release(now);
}

void RosserialHost::commandForce(const HandForce& force, const HandMotion& caused_by, double now)
{
  ++counters_.forces_received;
  if (!std::isfinite(force.force) || !std::isfinite(force.torque))
  {
    ++counters_.forces_not_finite;
    not_finite_at_ = now;
    force_.release(now);
  }
  else
  {
    force_at_ = now;
    if (!is_placed_ && isFinite(caused_by))
    {
      motion_.startAt(caused_by);
      is_placed_ = true;
    }
    answered_time_ = sample_times_.find(caused_by).value_or(answered_time_);
    const HandForce shaped = shaper_.shape(force, now);
    if (isTrusted(now))
      force_.command(shaped, now);
    else
      force_.release(now);
  }
  urgent_ = true;
}

void RosserialHost::setSimulationState(const std::string& reason, double now)
{
  standstill_reason_ = reason;
  if (!isTrusted(now))
    force_.release(now);
  updateState(now);
}

bool RosserialHost::isTrusted(double now) const
{
  const bool is_held = (flags_ & HapticSample::kEnabled) != 0 && (flags_ & HapticSample::kFault) == 0;
  return open_ && linked_ && is_held && standstill_reason_.empty() && topics_.samples() && topics_.force() &&
         now < sample_at_ + options_.timing.sample_ramp_age && now < force_at_ + options_.timing.force_ramp_age &&
         now >= not_finite_at_ + options_.timing.fault_hold;
}

void RosserialHost::tick(double now, const WallTime& wall)
{
  const HostTiming& timing = options_.timing;
  if (linked_ && now >= sample_at_ + timing.sample_timeout)
  {
    linked_ = false;
    ++counters_.links_lost;
    motion_.hold();
    shaper_.reset();
    force_.cut();
    clearDeviceClock();
    urgent_ = true;
  }
  const bool trusted = isTrusted(now);
  urgent_ = urgent_ || trusted != trusted_;
  trusted_ = trusted;
  if (!trusted)
    force_.release(now);
  if (open_ && (!linked_ || !topics_.samples() || !topics_.force()) && now >= request_at_ + timing.request_period)
    requestTopics(now);
  updateState(now);
  const double period = force_.isMoving() ? timing.ramp_period : timing.keep_alive;
  if (!topics_.force() || (!urgent_ && now < sent_at_ + period))
    return;
  output_.setLatest(forceFrame(now, wall));
  urgent_ = false;
  sent_at_ = now;
}

double RosserialHost::wakeAt() const
{
  const HostTiming& timing = options_.timing;
  if (!open_)
    return std::numeric_limits<double>::infinity();
  double wake = sent_at_ + (force_.isMoving() ? timing.ramp_period : timing.keep_alive);
  if (!topics_.force())
    wake = request_at_ + timing.request_period;
  if (linked_)
    wake = std::min(wake, sample_at_ + timing.sample_timeout);
  if (trusted_)
    wake = std::min({wake, sample_at_ + timing.sample_ramp_age, force_at_ + timing.force_ramp_age});
  return wake;
}

void RosserialHost::shutDown(double now, const WallTime& wall)
{
  force_.cut();
  if (!open_)
    return;
  open_ = false;
  closed_reason_ = "the host was shut down";
  updateState(now);
  Bytes final_frames = topics_.force() ? forceFrame(now, wall) : Bytes();
  const Bytes stop = encodeFrame(kTxStop, {});
  final_frames.insert(final_frames.end(), stop.begin(), stop.end());
  output_.setLatest(std::move(final_frames));
}

void RosserialHost::clearDeviceClock()
{
  sample_times_.clear();
  answered_time_ = 0;
}

void RosserialHost::requestTopics(double now)
{
  request_at_ = now;
  ++counters_.topic_requests;
  output_.pushControl(encodeTopicRequest());
}

void RosserialHost::updateState(double now)
{
  const HostTiming& timing = options_.timing;
  const auto enter = [this](DeviceState state, const std::string& reason)
  {
    urgent_ = urgent_ || state != state_;
    state_ = state;
    reason_ = reason;
  };
  if (!open_)
    enter(DeviceState::kDisabled, closed_reason_);
  else if (!topics_.samples())
    enter(DeviceState::kDisabled, topics_.refused().empty()
                                      ? "the device has not announced its topics"
                                      : "no topic with samples; " + topics_.refused().begin()->second.topic.name +
                                            " refused: " + topics_.refused().begin()->second.reason);
  else if (counters_.samples == samples_at_opening_)
    enter(DeviceState::kDisabled, "the device has not sent a sample");
  else if (!linked_)
    enter(DeviceState::kDisabled, "no sample for " + milliseconds(timing.sample_timeout));
  else if ((flags_ & HapticSample::kFault) != 0)
    enter(DeviceState::kFault, "the device reports a fault");
  else if (now < not_finite_at_ + timing.fault_hold)
    enter(DeviceState::kFault, "the simulation sent a force that is not a number");
  else if ((flags_ & HapticSample::kEnabled) == 0)
    enter(DeviceState::kDisabled, "the hand does not hold the instrument");
  else if (!topics_.force())
    enter(DeviceState::kPaused, "the device has not subscribed to the force");
  else if (!standstill_reason_.empty())
    enter(DeviceState::kPaused, standstill_reason_);
  else if (now >= force_at_ + timing.force_timeout)
    enter(DeviceState::kPaused, "no force from the simulation for " + milliseconds(timing.force_timeout));
  else
    enter(DeviceState::kEnabled, "");
}

Bytes RosserialHost::forceFrame(double now, const WallTime& wall)
{
  const HandForce value = force_.advance(now);
  shaper_.rendered(value, now);
  const TopicRegistry::Channel& channel = *topics_.force();
  HapticForce message;
  message.sample_time = answered_time_;
  message.force = static_cast<float>(value.force);
  message.torque = static_cast<float>(value.torque);
  message.state = state_;
  Wrench wrench;
  wrench.force[0] = value.force;
  wrench.torque[0] = value.torque;
  Bytes payload;
  if (channel.format == PayloadFormat::kHapticForce)
    payload = encode(message);
  else if (channel.format == PayloadFormat::kWrench)
    payload = encode(wrench);
  else
    payload = encodeStamped(wrench, wall);
  return encodeFrame(channel.topic.id, payload);
}

std::vector<MotionSample> RosserialHost::takeMotion()
{
  return std::exchange(motion_out_, {});
}

std::vector<LogLine> RosserialHost::takeLog()
{
  return std::exchange(log_out_, {});
}

}  // namespace endovascular_sim::haptics
