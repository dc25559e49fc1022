#pragma once

#include <cmath>

namespace endovascular_sim::drive
{

/** Position of a hand, or of a robot's clamp, on an instrument. */
struct HandMotion
{
  double insertion = 0.0;  ///< [m]
  double rotation = 0.0;   ///< [rad]
};

/** Largest change of the insertion between two samples of a motion; a larger one is a glitch or a restart [m]. */
constexpr double kLargestInsertionStep = 20e-3;
/** Largest change of the rotation between two samples of a motion [rad]. */
constexpr double kLargestRotationStep = 3.0;

inline bool isFinite(const HandMotion& motion)
{
  return std::isfinite(motion.insertion) && std::isfinite(motion.rotation);
}

/** Reports whether two samples differ by more than the largest change; both must be finite.
 *  @param step, turn largest changes [m], [rad] */
inline bool isJump(const HandMotion& from, const HandMotion& to, double step = kLargestInsertionStep,
                   double turn = kLargestRotationStep)
{
  return std::abs(to.insertion - from.insertion) > step || std::abs(to.rotation - from.rotation) > turn;
}

}  // namespace endovascular_sim::drive
