#include "nodes/runtime/line/frame_stream.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::size_t kBuffer = 64U << 10U;  ///< initial size of the buffer, that of a usual frame and more [B]

}  // namespace

FrameStream::FrameStream(int socket) : socket_(socket), is_open_(socket >= 0), buffer_(kBuffer) {}

FrameStream::~FrameStream()
{
  if (socket_ >= 0)
    ::close(socket_);
}

void FrameStream::close()
{
  if (is_open_.exchange(false))
    shutdown(socket_, SHUT_RDWR);
}

/** Waits for an event of the socket, or its end. @return false at the deadline */
bool FrameStream::waitFor(short events, Clock::time_point deadline) const
{
  const auto left = std::max(std::chrono::nanoseconds(0),
                             std::chrono::duration_cast<std::chrono::nanoseconds>(deadline - Clock::now()));
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
  timespec timeout{};
  timeout.tv_sec = seconds.count();
  timeout.tv_nsec = (left - seconds).count();
  pollfd descriptor{socket_, events, 0};
  return ppoll(&descriptor, 1, &timeout, nullptr) > 0;
}

/** Writes the unsent bytes. @return true when all are sent */
bool FrameStream::write(Clock::time_point deadline)
{
  while (sent_ < unsent_.size())
  {
    const ssize_t written =
        ::send(socket_, unsent_.data() + sent_, unsent_.size() - sent_, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (written > 0)
      sent_ += static_cast<std::size_t>(written);
    else if (errno != EAGAIN && errno != EINTR)
    {
      close();
      return false;
    }
    else if (!waitFor(POLLOUT, deadline) && Clock::now() >= deadline)
      return false;
  }
  unsent_.clear();
  sent_ = 0;
  return true;
}

bool FrameStream::send(const std::vector<std::uint8_t>& frame, Clock::time_point deadline)
{
  if (!is_open_ || frame.size() > kLargestFrame)
    return false;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!write(deadline))
    return false;
  const auto size = static_cast<std::uint32_t>(frame.size());
  unsent_.resize(kPrefix + frame.size());
  std::memcpy(unsent_.data(), &size, kPrefix);
  std::copy(frame.begin(), frame.end(), unsent_.begin() + kPrefix);
  write(deadline);
  return is_open_;
}

/** True with a complete frame at the begin of the buffer, which then has room for it. */
bool FrameStream::hasFrame()
{
  if (filled_ < kPrefix)
    return false;
  std::uint32_t size = 0;
  std::memcpy(&size, buffer_.data(), kPrefix);
  if (size > kLargestFrame)
  {
    close();
    return false;
  }
  if (buffer_.size() < kPrefix + size)
    buffer_.resize(kPrefix + size);
  if (filled_ < kPrefix + size)
    return false;
  size_ = size;
  is_given_ = true;
  return true;
}

/** Reads the bytes that have arrived. */
void FrameStream::read()
{
  const ssize_t count = recv(socket_, buffer_.data() + filled_, buffer_.size() - filled_, MSG_DONTWAIT);
  if (count > 0)
    filled_ += static_cast<std::size_t>(count);
  else if (count == 0 || (errno != EAGAIN && errno != EINTR))
    close();
}

bool FrameStream::receive(Clock::time_point deadline)
{
  if (is_given_)
  {
    filled_ -= kPrefix + size_;
    std::memmove(buffer_.data(), buffer_.data() + kPrefix + size_, filled_);
    is_given_ = false;
  }
  size_ = 0;
  while (is_open_ && !hasFrame())
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      write(Clock::time_point());  // the rest of a begun frame, as far as the peer takes it
    }
    if (!waitFor(POLLIN, deadline))
      return false;
    read();
  }
  return is_given_;
}

}  // namespace endovascular_sim::nodes
