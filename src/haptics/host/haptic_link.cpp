#include "haptics/host/haptic_link.h"

#include <algorithm>
#include <array>
#include <utility>

namespace endovascular_sim::haptics
{

namespace
{

constexpr double kReopenPeriod = 0.2;  // period of the attempts to open the line [s]
constexpr std::size_t kMaxReads = 16;  // reads per service(); a busy line must not starve the other tasks

HostOptions withBaud(HostOptions options, int baud)
{
  options.baud = baud;
  return options;
}

}  // namespace

HapticLink::HapticLink(LinkOptions options)
  : options_(std::move(options)), host_(withBaud(options_.host, options_.baud))
{
  SerialPort::checkBaud(options_.baud, "baud");
}

void HapticLink::service(double now, const WallTime& wall)
{
  if (!port_.isOpen() && now >= open_at_)
    tryToOpen(now);
  if (!port_.isOpen())
    return;
  readAll(now, wall);
  host_.tick(now, wall);
  flush(now);
}

void HapticLink::tryToOpen(double now)
{
  open_at_ = now + kReopenPeriod;
  if (port_.open(options_.port, options_.baud))
  {
    ++opened_;
    host_.lineOpened(now);
    return;
  }
  last_error_ = port_.error();
  host_.lineClosed(last_error_);
}

void HapticLink::readAll(double now, const WallTime& wall)
{
  std::array<std::uint8_t, 4096> bytes;
  for (std::size_t i = 0; i < kMaxReads; ++i)
  {
    const std::size_t count = port_.read(bytes.data(), bytes.size());
    if (count == 0)
      return;
    host_.receive(bytes.data(), count, now, wall);
  }
}

void HapticLink::commandForce(const HandForce& force, const HandMotion& caused_by, double now, const WallTime& wall)
{
  host_.commandForce(force, caused_by, now);
  if (!port_.isOpen())
    return;
  host_.tick(now, wall);
  flush(now);
}

void HapticLink::setSimulationState(const std::string& reason, double now, const WallTime& wall)
{
  host_.setSimulationState(reason, now);
  if (!port_.isOpen())
    return;
  host_.tick(now, wall);
  flush(now);
}

void HapticLink::shutDown(double now, const WallTime& wall)
{
  host_.shutDown(now, wall);
  flush(now);
}

void HapticLink::flush(double now)
{
  if (port_.isOpen())
    host_.output().flush(port_, now);
  dropLostLine(now);
}

void HapticLink::dropLostLine(double now)
{
  if (!port_.isLost())
    return;
  last_error_ = options_.port + ": " + port_.error();
  port_.close();
  host_.lineClosed("unplugged (" + last_error_ + "); trying to reopen it");
  open_at_ = now + kReopenPeriod;
}

double HapticLink::wakeAt() const
{
  if (!port_.isOpen())
    return open_at_;
  const WriteQueue& output = host_.output();
  const double host = host_.wakeAt();
  return output.empty() || output.blocked() ? host : std::min(host, output.lineFreeAt());
}

}  // namespace endovascular_sim::haptics
