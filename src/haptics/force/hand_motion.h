#pragma once

#include <cmath>

namespace endovascular_sim::haptics
{

/** Position of the user's hand on the instrument. */
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

/** Reports whether two samples differ by more than the largest change; both must be finite. */
inline bool isJump(const HandMotion& from, const HandMotion& to)
{
  return std::abs(to.insertion - from.insertion) > kLargestInsertionStep ||
         std::abs(to.rotation - from.rotation) > kLargestRotationStep;
}

}  // namespace endovascular_sim::haptics
