#pragma once

#include <cstddef>
#include <deque>

#include "haptics/rosserial/rosserial_protocol.h"

namespace endovascular_sim::haptics
{

/** Model of one direction of a UART line: a FIFO that transmits bytes in sequence at the speed of the line, 10 bits
 *  each. Bytes beyond the capacity of the FIFO are lost. */
class SerialLine
{
public:
  /** @param baud [bit/s] @param fifo_size [bytes] */
  SerialLine(double baud, std::size_t fifo_size) : byte_time_(10.0 / baud), fifo_size_(fifo_size) {}

  /** Appends bytes at time @p now [s]. */
  void push(const Bytes& bytes, double now);
  /** Removes and returns the bytes that have arrived at the other end by @p now [s]. */
  Bytes pull(double now);

  std::size_t backlog() const { return fifo_.size(); }                 ///< bytes in the FIFO
  std::size_t freeSpace() const { return fifo_size_ - fifo_.size(); }  ///< free capacity of the FIFO [bytes]
  /** Arrival time of the last byte in the FIFO [s]. */
  double emptyAt() const { return head_at_ + byte_time_ * (static_cast<double>(fifo_.size()) - 1.0); }
  std::uint64_t lost() const { return lost_; }  ///< bytes lost to a full FIFO

private:
  double byte_time_;
  std::size_t fifo_size_;
  std::deque<std::uint8_t> fifo_;
  double head_at_ = 0.0;  ///< arrival time of the first byte of the FIFO [s]
  double idle_at_ = 0.0;  ///< arrival time of the last byte that was pulled [s]
  std::uint64_t lost_ = 0;
};

}  // namespace endovascular_sim::haptics
