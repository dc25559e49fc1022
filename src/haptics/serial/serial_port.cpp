#include "haptics/serial/serial_port.h"

#include <fcntl.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "common/error.h"

namespace endovascular_sim::haptics
{

namespace
{

struct Speed
{
  int baud;
  speed_t code;
};

constexpr Speed kSpeeds[] = {{9600, B9600},       {19200, B19200},    {38400, B38400},     {57600, B57600},
                             {115200, B115200},   {230400, B230400},  {460800, B460800},   {500000, B500000},
                             {576000, B576000},   {921600, B921600},  {1000000, B1000000}, {1152000, B1152000},
                             {1500000, B1500000}, {2000000, B2000000}};

const Speed* findSpeed(int baud)
{
  const auto* found =
      std::find_if(std::begin(kSpeeds), std::end(kSpeeds), [baud](const Speed& speed) { return speed.baud == baud; });
  return found == std::end(kSpeeds) ? nullptr : found;
}

/** Requests low-latency mode from the driver of a USB adapter. An FTDI adapter buffers bytes for 16 ms otherwise. */
void requestLowLatency(int descriptor)
{
  serial_struct settings = {};
  if (ioctl(descriptor, TIOCGSERIAL, &settings) != 0)
    return;  // pty, or driver without this setting
  settings.flags |= ASYNC_LOW_LATENCY;
  ioctl(descriptor, TIOCSSERIAL, &settings);
}

}  // namespace

void SerialPort::checkBaud(int baud, const std::string& where)
{
  if (findSpeed(baud) != nullptr)
    return;
  std::string list;
  for (const Speed& speed : kSpeeds)
    list += (list.empty() ? "" : ", ") + std::to_string(speed.baud);
  throw InputError(where, std::to_string(baud), "is not a standard baud rate; choose one of " + list + " [bit/s]");
}

bool SerialPort::open(const std::string& path, int baud)
{
  close();
  descriptor_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0)
  {
    error_ = path + ": " + std::strerror(errno);
    return false;
  }
  if (configure(baud))
    return true;
  error_ = path + ": " + std::strerror(errno);
  close();
  return false;
}

bool SerialPort::configure(int baud)
{
  const Speed* speed = findSpeed(baud);
  termios settings = {};
  if (speed == nullptr)
  {
    errno = EINVAL;
    return false;
  }
  if (tcgetattr(descriptor_, &settings) != 0)
    return false;
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(HUPCL | CSTOPB | CRTSCTS);
  settings.c_cc[VMIN] = 1;  // a read of 0 bytes then indicates a hang-up, not an empty buffer
  settings.c_cc[VTIME] = 0;
  if (cfsetspeed(&settings, speed->code) != 0 || tcsetattr(descriptor_, TCSANOW, &settings) != 0)
    return false;
  ioctl(descriptor_, TIOCEXCL);
  requestLowLatency(descriptor_);
  tcflush(descriptor_, TCIOFLUSH);
  return true;
}

void SerialPort::close()
{
  if (descriptor_ >= 0)
    ::close(descriptor_);
  descriptor_ = -1;
  lost_ = false;
}

void SerialPort::markLost(const std::string& reason)
{
  lost_ = true;
  error_ = reason;
}

std::size_t SerialPort::read(std::uint8_t* data, std::size_t size)
{
  if (descriptor_ < 0 || lost_)
    return 0;
  const ssize_t count = ::read(descriptor_, data, size);
  if (count > 0)
    return static_cast<std::size_t>(count);
  if (count == 0)
    markLost("hung up");
  else if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
    markLost(std::strerror(errno));
  return 0;
}

std::size_t SerialPort::write(const std::uint8_t* data, std::size_t size)
{
  if (descriptor_ < 0 || lost_)
    return 0;
  const ssize_t count = ::write(descriptor_, data, size);
  if (count >= 0)
    return static_cast<std::size_t>(count);
  if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
    markLost(std::strerror(errno));
  return 0;
}

}  // namespace endovascular_sim::haptics
