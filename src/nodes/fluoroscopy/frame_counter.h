#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace endovascular_sim::nodes
{

/** Counts the frames of a sequence, and those that are left out because earlier ones or other programs take too long.
 */
class FrameCounter
{
public:
  /** @param period of the frames [s] */
  explicit FrameCounter(double period) : period_(period) {}

  /** A frame is drawn. @param time at which it was due [s] */
  void draw(double time)
  {
    if (running_ && time > last_)
      left_out_ += static_cast<std::size_t>(std::max(0.0, std::floor((time - last_) / period_ + 0.5) - 1.0));
    running_ = true;
    last_ = time;
    ++drawn_;
  }

  /** Nobody sees the frames: the next one begins a new sequence. */
  void pause() { running_ = false; }

  std::size_t drawn() const { return drawn_; }
  std::size_t leftOut() const { return left_out_; }

private:
  double period_;
  double last_ = 0.0;  ///< time of the last frame of the sequence [s]
  bool running_ = false;
  std::size_t drawn_ = 0, left_out_ = 0;
};

}  // namespace endovascular_sim::nodes
