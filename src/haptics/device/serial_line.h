#pragma once

#include <cstddef>
#include <deque>

#include "haptics/rosserial/rosserial_protocol.h"

namespace endovascular_sim::haptics
{

/** One direction of a serial line as a UART makes it: a fifo, and bytes that leave one after the other at the
 *  line's speed, 10 bits each. What does not fit into the fifo is lost. */
class SerialLine
{
public:
  /** @param baud [bit/s] @param fifo_size [bytes] */
  SerialLine(double baud, std::size_t fifo_size) : byte_time_(10.0 / baud), fifo_size_(fifo_size) {}

  /** Puts bytes in at time @p now [s]. */
  void push(const Bytes& bytes, double now);
  /** Takes the bytes that have arrived at the far end by @p now. */
  Bytes pull(double now);

  std::size_t backlog() const { return fifo_.size(); }
  std::size_t room() const { return fifo_size_ - fifo_.size(); }
  /** When the last byte that is under way arrives [s]. */
  double emptyAt() const { return head_at_ + byte_time_ * (static_cast<double>(fifo_.size()) - 1.0); }
  std::uint64_t lost() const { return lost_; }  ///< bytes that found the fifo full

private:
  double byte_time_;
  std::size_t fifo_size_;
  std::deque<std::uint8_t> fifo_;
  double head_at_ = 0.0;  ///< arrival of the first byte of the fifo
  double idle_at_ = 0.0;  ///< arrival of the last byte that was pulled
  std::uint64_t lost_ = 0;
};

}  // namespace endovascular_sim::haptics
