#include "haptics/serial/write_queue.h"

#include <algorithm>
#include <utility>

namespace endovascular_sim::haptics
{

namespace
{

constexpr std::size_t kControlDepth = 16;
constexpr double kBitsPerByte = 10.0;  // start bit, 8 data bits, stop bit
constexpr double kLead = 0.2e-3;       // lead of the next write before the line becomes idle [s]

}  // namespace

void WriteQueue::pushControl(Bytes frame)
{
  if (control_.size() >= kControlDepth)
    ++dropped_;
  else
    control_.push_back(std::move(frame));
}

void WriteQueue::setLatest(Bytes frame)
{
  if (latest_)
    ++superseded_;
  latest_ = std::move(frame);
}

bool WriteQueue::takeNext()
{
  if (!control_.empty())
  {
    current_ = std::move(control_.front());
    control_.pop_front();
  }
  else if (latest_)
  {
    current_ = std::move(*latest_);
    latest_.reset();
  }
  written_ = 0;
  return !current_.empty();
}

void WriteQueue::flush(ByteSink& sink, double now)
{
  blocked_ = false;
  while (!current_.empty() || (now + kLead >= line_free_at_ && takeNext()))
  {
    const std::size_t taken = sink.write(current_.data() + written_, current_.size() - written_);
    written_ += taken;
    if (baud_ > 0.0)
      line_free_at_ = std::max(now, line_free_at_) + static_cast<double>(taken) * kBitsPerByte / baud_;
    if (written_ < current_.size())
    {
      blocked_ = true;
      return;
    }
    current_.clear();
    ++sent_;
  }
}

void WriteQueue::clear()
{
  current_.clear();
  control_.clear();
  latest_.reset();
  written_ = 0;
  blocked_ = false;
  line_free_at_ = 0.0;
}

}  // namespace endovascular_sim::haptics
