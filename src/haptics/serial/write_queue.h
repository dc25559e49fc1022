#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "haptics/rosserial/rosserial_protocol.h"

namespace endovascular_sim::haptics
{

/** Interface of a non-blocking sink of bytes. */
class ByteSink
{
public:
  virtual ~ByteSink() = default;
  /** @return number of bytes accepted; 0 if the sink is full */
  virtual std::size_t write(const std::uint8_t* data, std::size_t size) = 0;
};

/** Priority queue of outgoing frames, written one at a time and never interleaved.
 *
 *  Protocol frames (time, topic request) precede force frames and retain their order. Only the latest force frame is
 *  retained. A partially written frame is always completed. The queue is paced: a frame is written when the previous
 *  one has left the line, so that forces do not age in the operating system's buffer. */
class WriteQueue
{
public:
  /** @param baud speed of the line at 10 bits per byte [bit/s]; 0: no pacing */
  explicit WriteQueue(double baud = 0.0) : baud_(baud) {}

  /** Appends a protocol frame; it is dropped and counted if 16 are queued already. */
  void pushControl(Bytes frame);
  /** Queues a force frame and replaces a queued one. */
  void setLatest(Bytes frame);
  /** Writes the frames that are due at time @p now [s]. */
  void flush(ByteSink& sink, double now);
  /** Discards all frames, including a partially written one, after the line was closed. */
  void clear();

  bool empty() const { return current_.empty() && control_.empty() && !latest_; }
  /** True if the sink accepted only a part of the current frame. */
  bool blocked() const { return blocked_; }
  /** Time at which the line has transmitted all written bytes [s]. */
  double lineFreeAt() const { return line_free_at_; }

  std::uint64_t superseded() const { return superseded_; }  ///< force frames replaced before they were written
  std::uint64_t dropped() const { return dropped_; }        ///< protocol frames dropped
  std::uint64_t sent() const { return sent_; }              ///< frames written completely

private:
  bool takeNext();

  double baud_;
  Bytes current_;
  std::size_t written_ = 0;  ///< bytes of current_ already written
  std::deque<Bytes> control_;
  std::optional<Bytes> latest_;
  bool blocked_ = false;
  double line_free_at_ = 0.0;
  std::uint64_t superseded_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace endovascular_sim::haptics
