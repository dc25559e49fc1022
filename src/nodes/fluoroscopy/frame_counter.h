#pragma once

#include <cstdint>

namespace endovascular_sim::nodes
{

/** Counts the pulses of a sequence that are drawn, and those that are left out because earlier ones or other programs
 *  take too long. */
class FrameCounter
{
public:
  /** A pulse is drawn. An earlier one than the last begins a new sequence; the last one again is not counted. */
  void draw(std::uint64_t pulse)
  {
    if (running_ && pulse == last_)
      return;
    if (running_ && pulse > last_)
      left_out_ += pulse - last_ - 1;
    running_ = true;
    last_ = pulse;
    ++drawn_;
  }

  /** Nobody sees the frames: the next one begins a new sequence. */
  void pause() { running_ = false; }

  std::uint64_t drawn() const { return drawn_; }
  std::uint64_t leftOut() const { return left_out_; }

private:
  std::uint64_t last_ = 0;  ///< pulse of the last frame of the sequence
  bool running_ = false;
  std::uint64_t drawn_ = 0, left_out_ = 0;
};

}  // namespace endovascular_sim::nodes
