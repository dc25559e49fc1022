#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <vector>

namespace endovascular_sim::nodes
{

/** Frames of bytes over a connected local socket, each with its length before it. One thread receives, any thread
 *  sends. A lost connection closes the stream; no call throws. */
class FrameStream
{
public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint32_t kLargestFrame = 64U << 20U;  ///< a larger one closes the stream [B]

  /** @param socket connected stream socket, closed with this object; negative: the stream is closed */
  explicit FrameStream(int socket);
  ~FrameStream();
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  bool isOpen() const { return is_open_; }

  /** Sends a frame. A peer that does not read delays the call until the deadline at most; the stream keeps the rest of
   *  a frame that was begun.
   *  @return false when the frame is not on its way: the stream is closed, or has yet to send the frame before */
  bool send(const std::vector<std::uint8_t>& frame, Clock::time_point deadline);

  /** Waits for a frame until the deadline. @return true with the next one in frame() */
  bool receive(Clock::time_point deadline);

  /** Last received frame, valid until the next call of receive(). */
  const std::uint8_t* frame() const { return buffer_.data() + kPrefix; }
  std::uint32_t frameSize() const { return size_; }

  /** True when bytes of a further frame have been read. */
  bool hasMore() const { return filled_ > kPrefix + size_; }

  /** Ends the connection; the peer and a waiting receive() notice it. */
  void close();

private:
  static constexpr std::size_t kPrefix = sizeof(std::uint32_t);

  bool hasFrame();
  void read();
  bool write(Clock::time_point deadline);
  bool waitFor(short events, Clock::time_point deadline) const;

  int socket_;
  std::atomic<bool> is_open_;
  std::vector<std::uint8_t> buffer_;  ///< read bytes: the last frame with its length, then those of the next one
  std::size_t filled_ = 0;            ///< read bytes in the buffer [B]
  std::uint32_t size_ = 0;            ///< of the last frame [B]
  bool is_given_ = false;             ///< true when the buffer begins with the last frame
  std::mutex mutex_;                  ///< guards the next two
  std::vector<std::uint8_t> unsent_;  ///< bytes of a begun frame
  std::size_t sent_ = 0;              ///< of unsent_ [B]
};

}  // namespace endovascular_sim::nodes
