#pragma once

#include <string>
#include <vector>

#include "haptics/force/motion_reference.h"

namespace endovascular_sim::haptics
{

/** Scripted motion of the hand: rows of time [s], insertion [m], rotation [rad].
 *
 *  Positions are interpolated linearly, and constant before the first and after the last row. */
class MotionScript
{
public:
  /** Reads a script.
   *  @param file CSV file with one row per point at increasing times; lines that begin with # or a letter are skipped
   *  @throws InputError with file and line */
  static MotionScript load(const std::string& file);

  /** Interpolated position at @p time [s]. */
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
