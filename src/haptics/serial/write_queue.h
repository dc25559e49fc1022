#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "haptics/rosserial/rosserial_protocol.h"

namespace endovascular_sim::haptics
{

/** Something that takes bytes without blocking. */
class ByteSink
{
public:
  virtual ~ByteSink() = default;
  /** @return how many bytes were taken, 0 when none can be taken now */
  virtual std::size_t write(const std::uint8_t* data, std::size_t size) = 0;
};

/** Orders what goes out on the line: one frame at a time, never interleaved.
 *
 *  Protocol frames (time, topic request) go in order and first; of the force frames only the latest is kept. A frame
 *  that has begun is completed. The queue keeps to the line's speed, so that forces do not age in the
 *  operating system's buffer: a frame is handed over when the one before has left the line. */
class WriteQueue
{
public:
  /** @param baud speed of the line, 10 bits per byte; 0: not paced [bit/s] */
  explicit WriteQueue(double baud = 0.0) : baud_(baud) {}

  /** Appends a protocol frame; beyond 16 waiting ones it is dropped and counted. */
  void pushControl(Bytes frame);
  /** Replaces the force frame that waits, if any. */
  void setLatest(Bytes frame);
  /** Hands over what the line takes at time @p now [s]. */
  void flush(ByteSink& sink, double now);
  /** Forgets everything, also a half-written frame (the line was closed). */
  void clear();

  bool empty() const { return current_.empty() && control_.empty() && !latest_; }
  /** A frame has begun and the sink took only a part of it. */
  bool blocked() const { return blocked_; }
  /** When the line has carried what it was given [s]. */
  double lineFreeAt() const { return line_free_at_; }

  std::uint64_t superseded() const { return superseded_; }  ///< forces replaced before they left
  std::uint64_t dropped() const { return dropped_; }        ///< protocol frames dropped
  std::uint64_t sent() const { return sent_; }              ///< frames handed over completely

private:
  bool takeNext();

  double baud_;
  Bytes current_;
  std::size_t written_ = 0;  ///< of current_
  std::deque<Bytes> control_;
  std::optional<Bytes> latest_;
  bool blocked_ = false;
  double line_free_at_ = 0.0;
  std::uint64_t superseded_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace endovascular_sim::haptics
