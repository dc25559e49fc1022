#include "haptics/serial/serial_port.h"

#include <asm/termbits.h>  // termios2; excludes <termios.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "common/error.h"

namespace endovascular_sim::haptics
{

namespace
{

constexpr int kSlowest = 1200;       // bit/s
constexpr int kFastest = 12000000;   // bit/s, of high-speed USB adapters
constexpr double kTolerance = 0.03;  // of the speed that the driver sets; a UART samples correctly up to it

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
  if (baud < kSlowest || baud > kFastest)
    throw InputError(where, std::to_string(baud),
                     "is no speed of a serial line; must be between " + std::to_string(kSlowest) + " and " +
                         std::to_string(kFastest) + " bit/s, as in the device's firmware");
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
  error_ = path + ": " + error_;
  close();
  return false;
}

/** Sets any speed (BOTHER), not only those that POSIX names. */
bool SerialPort::configure(int baud)
{
  termios2 settings = {};
  if (ioctl(descriptor_, TCGETS2, &settings) != 0)
    return refuse(std::strerror(errno));
  // Raw mode, as cfmakeraw().
  settings.c_iflag &= ~static_cast<tcflag_t>(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON);
  settings.c_oflag &= ~static_cast<tcflag_t>(OPOST);
  settings.c_lflag &= ~static_cast<tcflag_t>(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSIZE | PARENB | HUPCL | CSTOPB | CRTSCTS | CBAUD | (CBAUD << IBSHIFT));
  settings.c_cflag |= CS8 | CLOCAL | CREAD | BOTHER | (BOTHER << IBSHIFT);
  settings.c_ispeed = settings.c_ospeed = static_cast<speed_t>(baud);
  settings.c_cc[VMIN] = 1;  // a read of 0 bytes then indicates a hang-up, not an empty buffer
  settings.c_cc[VTIME] = 0;
  if (ioctl(descriptor_, TCSETS2, &settings) != 0 || ioctl(descriptor_, TCGETS2, &settings) != 0)
    return refuse(std::strerror(errno));
  if (std::abs(static_cast<double>(settings.c_ospeed) - baud) > kTolerance * baud)
    return refuse("its driver sets " + std::to_string(settings.c_ospeed) + " bit/s in place of " +
                  std::to_string(baud) + "; choose a speed that the adapter supports, in the firmware and here");
  ioctl(descriptor_, TIOCEXCL);
  requestLowLatency(descriptor_);
  ioctl(descriptor_, TCFLSH, TCIOFLUSH);
  return true;
}

bool SerialPort::refuse(const std::string& reason)
{
  error_ = reason;
  return false;
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
