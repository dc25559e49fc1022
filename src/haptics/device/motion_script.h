#pragma once

#include <string>
#include <vector>

#include "haptics/force/motion_reference.h"

namespace endovascular_sim::haptics
{

/** A recorded or written motion of the hand: rows of time [s], insertion [m], rotation [rad]; linear in between,
 *  held before the first and after the last row. */
class MotionScript
{
public:
  /** @param file CSV with one row per point, times increasing; lines that begin with # or a letter are skipped
   *  @throws InputError naming file and line */
  static MotionScript load(const std::string& file);

  HandMotion at(double time) const;
  /** Time of the last row [s]. */
  double duration() const { return points_.back().time; }

private:
  struct Point
  {
    double time = 0.0;
    HandMotion motion;
  };
  std::vector<Point> points_;  ///< never empty
};

}  // namespace endovascular_sim::haptics
