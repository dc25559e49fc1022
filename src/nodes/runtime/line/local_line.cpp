#include "nodes/runtime/line/local_line.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "common/hash.h"

namespace endovascular_sim::nodes
{
namespace
{

using Clock = FrameStream::Clock;
constexpr std::chrono::milliseconds kPoll{100};           ///< interval in which a waiting thread looks for its end
constexpr std::chrono::milliseconds kServerPatience{50};  ///< longest wait for a peer that does not read
constexpr std::chrono::milliseconds kClientPatience{1};   ///< the same for the loop of the simulation
constexpr std::chrono::milliseconds kRetry{20};           ///< interval of attempts to connect

/** Name in the abstract name space, which the kernel frees with the socket. */
std::pair<sockaddr_un, socklen_t> addressOf(const std::string& name)
{
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t length = std::min(name.size(), sizeof(address.sun_path) - 1);
  std::memcpy(address.sun_path + 1, name.data(), length);
  return {address, static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length)};
}

const sockaddr* pointerTo(const sockaddr_un& address)
{
  return reinterpret_cast<const sockaddr*>(&address);  // NOLINT: the interface of the operating system
}

int localSocket(int flags)
{
  return socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | flags, 0);
}

/** Any account of the machine may take the name of a line or connect to it. */
bool isOfThisAccount(int socket)
{
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}

/** @return −1 when the name is in use */
int listenAt(const std::string& name)
{
  const int listener = localSocket(SOCK_NONBLOCK);
  const auto [address, size] = addressOf(name);
  if (listener >= 0 && bind(listener, pointerTo(address), size) == 0 && listen(listener, 1) == 0)
    return listener;
  if (listener >= 0)
    close(listener);
  return -1;
}

/** @return −1 without a server of this account */
int connectTo(const std::string& name)
{
  const int connection = localSocket(SOCK_NONBLOCK);
  const auto [address, size] = addressOf(name);
  if (connection >= 0 && connect(connection, pointerTo(address), size) == 0 && isOfThisAccount(connection))
    return connection;
  if (connection >= 0)
    close(connection);
  return -1;
}

}  // namespace

std::string lineName(const std::string& master, const std::string& topic)
{
  Hash64 hash;
  hash.add(master);
  hash.add(topic);
  return "endovascular_sim/" + hash.hex();
}

LineServer::LineServer(const std::string& name, Receive receive)
  : listener_(listenAt(name)), receive_(std::move(receive)), thread_([this] { loop(); })
{
}

LineServer::~LineServer()
{
  stop_ = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stream_)
      stream_->close();
  }
  thread_.join();
  if (listener_ >= 0)
    close(listener_);
}

bool LineServer::send(const std::vector<std::uint8_t>& frame)
{
  std::shared_ptr<FrameStream> stream;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stream = stream_;
  }
  return stream && stream->send(frame, Clock::now() + kServerPatience);
}

/** Accepts one peer after the other. */
void LineServer::loop()
{
  while (!stop_ && listener_ >= 0)
  {
    pollfd descriptor{listener_, POLLIN, 0};
    if (poll(&descriptor, 1, static_cast<int>(kPoll.count())) <= 0)
      continue;
    const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0)
      continue;
    if (!isOfThisAccount(connection))
    {
      close(connection);
      continue;
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stream_ = std::make_shared<FrameStream>(connection);
    }
    serve();
    const std::lock_guard<std::mutex> lock(mutex_);
    stream_.reset();
  }
}

/** Passes the frames of a peer on until it has gone. */
void LineServer::serve()
{
  is_connected_ = true;
  while (!stop_ && stream_->isOpen())
  {
    if (!stream_->receive(Clock::now() + kPoll))
      continue;
    bool has_frame = true;
    while (has_frame && stream_->hasMore())  // of a peer that has not waited for the answer
      has_frame = stream_->receive(Clock::now() + kPoll);
    if (has_frame)
      receive_(stream_->frame(), stream_->frameSize());
  }
  is_connected_ = false;
}

bool LineClient::connect()
{
  const Clock::time_point now = Clock::now();
  if (stream_ && stream_->isOpen())
    return true;
  is_connected_ = false;
  if (now - tried_ < kRetry)
    return false;
  tried_ = now;
  stream_ = std::make_unique<FrameStream>(connectTo(name_));
  is_connected_ = stream_->isOpen();
  return is_connected_;
}

bool LineClient::send(const std::vector<std::uint8_t>& frame)
{
  const bool is_sent = connect() && stream_->send(frame, Clock::now() + kClientPatience);
  is_connected_ = stream_ && stream_->isOpen();
  return is_sent;
}

const FrameStream* LineClient::receive(Clock::time_point deadline)
{
  const bool has_frame = stream_ && stream_->receive(deadline);
  is_connected_ = stream_ && stream_->isOpen();
  return has_frame ? stream_.get() : nullptr;
}

}  // namespace endovascular_sim::nodes
