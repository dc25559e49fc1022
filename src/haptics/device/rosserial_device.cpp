#include "haptics/device/rosserial_device.h"

#include <utility>

#include "haptics/rosserial/byte_stream.h"

namespace endovascular_sim::haptics
{

std::vector<HapticForce> RosserialDevice::receive(const std::uint8_t* data, std::size_t size, double now)
{
  std::vector<Frame> frames;
  parser_.feed(data, size, frames);
  std::vector<HapticForce> forces;
  for (const Frame& frame : frames)
  {
    try
    {
      if (const auto force = handle(frame, now))
        forces.push_back(*force);
    }
    catch (const PayloadError&)
    {
      // As in the firmware, a malformed payload is dropped. The watchdog handles the missing force.
    }
  }
  return forces;
}

std::optional<HapticForce> RosserialDevice::handle(const Frame& frame, double now)
{
  if (frame.id == kPublisher && frame.payload.empty())
  {
    announce(now);
  }
  else if (frame.id == kTime)
  {
    decodeTime(frame.payload);
    time_known_ = true;
  }
  else if (frame.id == kTxStop)
  {
    ++stops_;
    announced_ = time_known_ = false;
  }
  else if (frame.id == kForceId)
  {
    HapticForce force;
    if (options_.force.format == PayloadFormat::kHapticForce)
    {
      force = decodeHapticForce(frame.payload);
    }
    else
    {
      const Wrench wrench = decodeWrench(frame.payload);
      force.force = static_cast<float>(wrench.force[0]);
      force.torque = static_cast<float>(wrench.torque[0]);
      force.state = DeviceState::kEnabled;
    }
    rendered_force_ = force;
    force_at_ = now;
    force_seen_ = true;
    return force;
  }
  return std::nullopt;
}

void RosserialDevice::announce(double now)
{
  requestTime(now);
  TopicInfo sample{kSampleId, "haptic/sample", options_.sample.type, options_.sample.md5, options_.buffer_size};
  TopicInfo force{kForceId, "haptic/force", options_.force.type, options_.force.md5, options_.buffer_size};
  append(encodeFrame(kPublisher, encode(sample)));
  append(encodeFrame(kSubscriber, encode(force)));
  announced_ = true;
}

void RosserialDevice::requestTime(double now)
{
  time_requested_at_ = now;
  append(encodeFrame(kTime, encode(WallTime())));
}

void RosserialDevice::tick(double now)
{
  if (announced_ && now - time_requested_at_ >= options_.time_period)
    requestTime(now);
  if (force_seen_ && now - force_at_ >= options_.force_timeout)
  {
    force_seen_ = false;
    rendered_force_ = HapticForce();
    ++watchdog_trips_;
  }
}

void RosserialDevice::sendSample(const HapticSample& sample)
{
  if (!announced_)
    return;
  if (options_.sample.format == PayloadFormat::kHapticSample)
  {
    append(encodeFrame(kSampleId, encode(sample)));
    return;
  }
  JointState state;
  state.sequence = sequence_++;
  state.stamp = {sample.time / 1000000U, sample.time % 1000000U * 1000U};
  state.names = {"insertion", "rotation"};
  state.positions = {sample.insertion, sample.rotation};
  append(encodeFrame(kSampleId, encode(state)));
}

void RosserialDevice::sendLog(std::uint8_t level, const std::string& text)
{
  append(encodeFrame(kLog, encode(LogLine{level, text})));
}

void RosserialDevice::append(const Bytes& frame)
{
  output_.insert(output_.end(), frame.begin(), frame.end());
}

Bytes RosserialDevice::takeOutput()
{
  return std::exchange(output_, {});
}

}  // namespace endovascular_sim::haptics
