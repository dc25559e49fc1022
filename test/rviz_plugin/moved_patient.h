#pragma once

#include <cstdint>

#include "endovascular_sim/MotionState.h"
#include "nodes/conversions/motion_conversions.h"

namespace endovascular_sim::rviz_plugin
{

/** Motion of a heart at the origin whose fade ends at 8 mm: it shortens, twists and moves.
 *  @param share of its amplitudes */
inline MotionState motionMessage(std::uint64_t step, double share = 1.0)
{
  MotionState message;
  message.step = step;
  message.heart_rate = 1.2;
  message.breathing_rate = 0.25;
  message.axis.z = 1.0;
  message.length = 0.1;
  message.fade_core = 2e-3;
  message.fade_reach = 8e-3;
  message.shift.x = 1e-3 * share;
  message.shift.z = -5e-4 * share;
  message.linear = {-0.05 * share, 0.0, 0.0, 0.0, -0.05 * share, 0.0, 0.0, 0.0, -0.1 * share};
  message.twist = 3.0 * share;
  return message;
}

inline motion::MotionMap movedPatient(double share = 1.0)
{
  return nodes::fromMessage(motionMessage(0, share));
}

/** The same for a heart as large as in a patient, with a motion of some 10 mm. */
inline motion::MotionMap movedLargePatient()
{
  MotionState message = motionMessage(0, 1.0);
  message.fade_core = 0.1;
  message.fade_reach = 0.3;
  message.shift.x = 8e-3;
  message.shift.z = -6e-3;
  message.twist = 2.0;
  return nodes::fromMessage(message);
}

}  // namespace endovascular_sim::rviz_plugin
