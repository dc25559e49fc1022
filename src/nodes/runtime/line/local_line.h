#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "nodes/runtime/line/frame_stream.h"

namespace endovascular_sim::nodes
{

/** Name of the local line of a topic: equal for all nodes of one ROS master.
 *  @param master URI of the master
 *  @param topic resolved name */
std::string lineName(const std::string& master, const std::string& topic);

/** End of a local line that accepts one peer of the same account and calls back, in its own thread, with each frame.
 *
 *  A local line joins two nodes of one machine that take turns. roscpp passes a message through two threads and six
 *  system calls at each end, a local line through one thread and two calls. */
class LineServer
{
public:
  using Receive = std::function<void(const std::uint8_t* frame, std::uint32_t size)>;

  /** Without the name, which another process holds, no peer connects.
   *  @param receive called with the newest frame; older ones that wait are dropped. It must not throw */
  LineServer(const std::string& name, Receive receive);
  ~LineServer();
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;

  bool isConnected() const { return is_connected_; }

  /** Sends a frame to the peer. @return false when it is not on its way */
  bool send(const std::vector<std::uint8_t>& frame);

private:
  void loop();
  void serve();

  int listener_;
  Receive receive_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> is_connected_{false};
  std::mutex mutex_;                     ///< guards the pointer to the stream
  std::shared_ptr<FrameStream> stream_;  ///< null without a peer
  std::thread thread_;
};

/** End of a local line that connects to a server of the same account. Used by one thread. */
class LineClient
{
public:
  explicit LineClient(std::string name) : name_(std::move(name)) {}

  /** True with a connection. Callable from any thread. */
  bool isConnected() const { return is_connected_; }

  /** Sends a frame; connects first where that is possible. @return false when it is not on its way */
  bool send(const std::vector<std::uint8_t>& frame);

  /** Waits for a frame until the deadline. @return null without one */
  const FrameStream* receive(FrameStream::Clock::time_point deadline);

private:
  bool connect();

  std::string name_;
  std::unique_ptr<FrameStream> stream_;
  std::atomic<bool> is_connected_{false};
  FrameStream::Clock::time_point tried_;  ///< time of the last attempt to connect
};

}  // namespace endovascular_sim::nodes
