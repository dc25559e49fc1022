#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

#include "fluoroscopy/motion/body_motion.h"

namespace endovascular_sim::nodes
{

/** Motions of the patient in the last steps, so that an image shows vessel and instruments of the same step although
 * their messages arrive in any order. */
class BodyMotionHistory
{
public:
  static constexpr std::size_t kSteps = 64;  ///< about a second of states for display

  /** Adds the motion of a step. After a step back, as in a replay, all later ones are forgotten. */
  void add(std::uint64_t step, const fluoroscopy::BodyMotion& motion)
  {
    while (!motions_.empty() && motions_.back().first >= step)
      motions_.pop_back();
    motions_.emplace_back(step, motion);
    if (motions_.size() > kSteps)
      motions_.pop_front();
  }

  /** Motion of a step, else the last one before it, else the first one; at rest without any. */
  const fluoroscopy::BodyMotion& at(std::uint64_t step) const
  {
    for (auto motion = motions_.rbegin(); motion != motions_.rend(); ++motion)
      if (motion->first <= step)
        return motion->second;
    return motions_.empty() ? at_rest_ : motions_.front().second;
  }

private:
  std::deque<std::pair<std::uint64_t, fluoroscopy::BodyMotion>> motions_;
  fluoroscopy::BodyMotion at_rest_;
};

}  // namespace endovascular_sim::nodes
