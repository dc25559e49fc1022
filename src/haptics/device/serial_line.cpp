#include "haptics/device/serial_line.h"

#include <algorithm>

namespace endovascular_sim::haptics
{

void SerialLine::push(const Bytes& bytes, double now)
{
  if (bytes.empty())
    return;
  if (fifo_.empty())
    head_at_ = std::max(now, idle_at_) + byte_time_;
  const std::size_t taken = std::min(bytes.size(), freeSpace());
  fifo_.insert(fifo_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken));
  lost_ += bytes.size() - taken;
}

Bytes SerialLine::pull(double now)
{
  Bytes arrived;
  while (!fifo_.empty() && head_at_ <= now)
  {
    arrived.push_back(fifo_.front());
    fifo_.pop_front();
    idle_at_ = head_at_;
    head_at_ += byte_time_;
  }
  return arrived;
}

}  // namespace endovascular_sim::haptics
