#include "haptics/device/device_simulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace endovascular_sim::haptics
{

namespace
{

constexpr std::size_t kDeviceFifo = 512;      // transmit buffer of a microcontroller's library [bytes]
constexpr std::size_t kHostBuffer = 4096;     // receive buffer of an operating system [bytes]
constexpr double kMaxLateSamples = 10.0;      // backlog beyond which samples are skipped, not sent in a burst
constexpr std::size_t kMaxUnanswered = 8192;  // samples retained for the measurement of motion to force

}  // namespace

DeviceSimulator::DeviceSimulator(SimulatorOptions options)
  : options_(std::move(options)), to_host_(options_.baud, kDeviceFifo), from_host_(options_.baud, kHostBuffer)
{
}

void DeviceSimulator::plug(double now)
{
  if (device_)
    collect(report_);
  device_.emplace(options_.device);
  to_host_ = SerialLine(options_.baud, kDeviceFifo);
  from_host_ = SerialLine(options_.baud, kHostBuffer);
  pty_.plug(options_.link);
  plugged_at_ = next_sample_at_ = now;
  zero_ = hand_;
  moved_times_.clear();
}

void DeviceSimulator::unplug()
{
  if (pty_.isPlugged())
    ++report_.unplugged;
  pty_.unplug();
}

std::uint32_t DeviceSimulator::clock(double now) const
{
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>((now - plugged_at_) * 1e6));
}

void DeviceSimulator::step(double now)
{
  if (!pty_.isPlugged())
    return;
  moveBytes(now);
  device_->tick(now);
  const bool start = options_.start == StartCondition::kSubscribed ? device_->isSubscribed() : enabled_seen_;
  if (!started_at_ && start)
    started_at_ = now;
  if (now < next_sample_at_)
    return;
  takeSample(now);
  const double period = 1.0 / options_.rate;
  next_sample_at_ += period;
  if (now - next_sample_at_ > kMaxLateSamples * period)
  {
    const double missed = std::floor((now - next_sample_at_) / period);
    report_.samples_skipped += static_cast<std::uint64_t>(missed);
    next_sample_at_ += missed * period;
  }
  moveBytes(now);
}

void DeviceSimulator::takeSample(double now)
{
  const HandMotion previous = hand_;
  const double time = motionTime(now);
  hand_ = options_.motion(time);
  HapticSample sample;
  sample.time = clock(now);
  sample.insertion = static_cast<float>(hand_.insertion - zero_.insertion);
  sample.rotation = static_cast<float>(hand_.rotation - zero_.rotation);
  sample.flags = flags_;
  if (hasStarted() && time >= options_.duration)
    sample.flags |= HapticSample::kEndOfScript;
  device_->sendSample(sample);
  ++report_.samples;
  if (hand_.insertion == previous.insertion && hand_.rotation == previous.rotation)
    return;
  moved_times_.push_back(sample.time);
  if (moved_times_.size() > kMaxUnanswered)
    moved_times_.pop_front();
}

void DeviceSimulator::moveBytes(double now)
{
  to_host_.push(device_->takeOutput(), now);
  const Bytes sent = to_host_.pull(now);
  if (!sent.empty())
    pty_.write(sent.data(), sent.size());

  std::array<std::uint8_t, kHostBuffer> bytes;
  const std::size_t count = pty_.read(bytes.data(), std::min(bytes.size(), from_host_.freeSpace()));
  from_host_.push(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count)), now);
  const Bytes received = from_host_.pull(now);
  for (const HapticForce& force : device_->receive(received.data(), received.size(), now))
    record(force, now);
  to_host_.push(device_->takeOutput(), now);
}

void DeviceSimulator::record(const HapticForce& force, double now)
{
  if (report_.forces == 0)
    report_.first_force_at = now;
  report_.last_force_at = now;
  ++report_.forces;
  report_.largest_force = std::max(report_.largest_force, std::abs(static_cast<double>(force.force)));
  report_.largest_torque = std::max(report_.largest_torque, std::abs(static_cast<double>(force.torque)));
  if (force.state != DeviceState::kEnabled)
    return;
  enabled_seen_ = true;
  ++report_.enabled_forces;
  if (force.sample_time == 0)
    return;  // not yet a response to a sample
  const double age = 1e-6 * static_cast<double>(clock(now) - force.sample_time);
  report_.latency.add(age);
  while (!moved_times_.empty() && moved_times_.front() < force.sample_time)
    moved_times_.pop_front();
  if (moved_times_.empty() || moved_times_.front() != force.sample_time)
    return;
  report_.motion_to_force.add(age);
  moved_times_.pop_front();
}

double DeviceSimulator::wakeAt() const
{
  double wake = next_sample_at_;
  if (to_host_.backlog() > 0)
    wake = std::min(wake, to_host_.emptyAt());
  if (from_host_.backlog() > 0)
    wake = std::min(wake, from_host_.emptyAt());
  return wake;
}

void DeviceSimulator::collect(Report& report) const
{
  report.watchdog_trips += device_->watchdogTrips();
  report.stops += device_->stops();
  report.resyncs += device_->parserCounters().resyncs;
  report.bytes_lost += to_host_.lost() + from_host_.lost();
}

DeviceSimulator::Report DeviceSimulator::report() const
{
  Report report = report_;
  if (device_)
    collect(report);
  return report;
}

double DeviceSimulator::Report::forceRate() const
{
  const double time = last_force_at - first_force_at;
  return forces > 1 && time > 0.0 ? static_cast<double>(forces - 1) / time : 0.0;
}

}  // namespace endovascular_sim::haptics
