#include "rviz_plugin/model/joystick.h"

#include <fcntl.h>
#include <linux/joystick.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <utility>

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kSearchPeriod = 2.0;   // [s]
constexpr double kDeadZone = 0.12;      // of a stick at rest
constexpr double kFullValue = 32767.0;  // of an axis
constexpr int kMostEvents = 1000;       // of one call
// Axes of the kernel's drivers of common gamepads.
constexpr std::uint8_t kLeftX = 0, kLeftY = 1, kRightX = 3;

double withDeadZone(std::int16_t value)
{
  const double share = std::clamp(value / kFullValue, -1.0, 1.0);
  const double beyond = std::max(std::abs(share) - kDeadZone, 0.0) / (1.0 - kDeadZone);
  return std::copysign(beyond, share);
}

}  // namespace

Joystick::Joystick(std::string device) : device_(std::move(device)) {}

Joystick::~Joystick()
{
  disconnect();
}

void Joystick::connect(double time)
{
  if (time - tried_ < kSearchPeriod)
    return;
  tried_ = time;
  file_ = open(device_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
}

void Joystick::disconnect()
{
  if (file_ >= 0)
    close(file_);
  file_ = -1;
  left_x_ = left_y_ = right_x_ = 0.0;
}

void Joystick::takeOver(std::uint8_t type, std::uint8_t number, std::int16_t value)
{
  const bool is_initial = (type & JS_EVENT_INIT) != 0;
  if ((type & JS_EVENT_BUTTON) != 0 && value != 0 && !is_initial)
    state_.pressed.push_back(number);
  if ((type & JS_EVENT_AXIS) == 0)
    return;
  if (number == kLeftX)
    left_x_ = withDeadZone(value);
  else if (number == kLeftY)
    left_y_ = withDeadZone(value);
  else if (number == kRightX)
    right_x_ = withDeadZone(value);
}

const JoystickState& Joystick::poll(double time)
{
  state_.pressed.clear();
  if (file_ < 0)
    connect(time);
  for (int k = 0; file_ >= 0 && k < kMostEvents; ++k)
  {
    js_event event{};
    const ssize_t bytes = read(file_, &event, sizeof event);
    if (bytes == static_cast<ssize_t>(sizeof event))
      takeOver(event.type, event.number, event.value);
    else if (bytes < 0 && errno == EINTR)
      continue;
    else if (bytes < 0 && errno == EAGAIN)
      break;
    else
      disconnect();  // unplugged
  }
  state_.is_connected = file_ >= 0;
  state_.push = -left_y_;  // forwards is negative
  state_.twist = std::abs(right_x_) > std::abs(left_x_) ? right_x_ : left_x_;
  return state_;
}

}  // namespace endovascular_sim::rviz_plugin
