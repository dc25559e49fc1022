#pragma once

#include <string>

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::motion
{

/** What a teacher changes during a run. */
struct MotionControls
{
  double heart_rate = 0.0;      ///< from the next beat on [Hz]
  double breathing_rate = 0.0;  ///< from the next breath on [Hz]
  bool breath_held = false;     ///< from the next end of an expiration on

  bool operator==(const MotionControls& other) const
  {
    return heart_rate == other.heart_rate && breathing_rate == other.breathing_rate && breath_held == other.breath_held;
  }
  bool operator!=(const MotionControls& other) const { return !(*this == other); }
};

void archive(Archive& archive, MotionControls& controls);

/** Reason for which controls are impossible; empty without one. A heart beats at 20 to 300 per minute; a patient
 *  breathes 1.8 to 60 times per minute. */
std::string refusalOf(const MotionControls& controls);

}  // namespace endovascular_sim::motion
