#pragma once

#include <algorithm>

namespace endovascular_sim::robot
{

// Play between a driving and a driven side. Both positions have one unit; the play is the full width of the free
// motion: the difference of the two positions is within ± half of it.

/** Position of the driven side after the driving side has moved (the play operator): it stays until the play is used
 *  up, and then follows with half of the play between the two. */
inline double drivenAfterPlay(double driven, double driving, double play)
{
  return std::clamp(driven, driving - 0.5 * play, driving + 0.5 * play);
}

/** Position of the driving side after the driven side has moved, or has been measured: the nearest one that the play
 *  permits. The inverse of drivenAfterPlay() where the play is used up, and the identity inside of it. */
inline double drivingAfterPlay(double driving, double driven, double play)
{
  return std::clamp(driving, driven - 0.5 * play, driven + 0.5 * play);
}

/** True if the driving side moves the driven side in a direction (positive or negative) without further play, up to
 *  rounding. */
inline bool isEngaged(double driven, double driving, double play, double direction)
{
  constexpr double kRounding = 1e-9;  // share of the play
  return play == 0.0 || (direction < 0.0 ? driven - driving : driving - driven) >= 0.5 * play * (1.0 - kRounding);
}

}  // namespace endovascular_sim::robot
