#pragma once

#include <cmath>
#include <optional>

#include "drive/hand_motion.h"

namespace endovascular_sim::drive
{

/** Closed interval. */
struct Interval
{
  double low = 0.0;
  double high = 0.0;

  bool contains(double value) const { return value >= low && value <= high; }
  double nearest(double value) const;  ///< value of the interval that is nearest to @p value
  Interval shifted(double by) const { return {low + by, high + by}; }
  bool operator==(const Interval& other) const { return low == other.low && high == other.high; }
};

/** Treatment of a command beyond a limit. */
enum class BeyondLimit
{
  kRefuse,  ///< the command has no effect
  kClamp,   ///< the limit replaces the value; a jump is approached
};

/** Motion where the instrument resists with more than the force limit, or cannot move further. */
enum class Grip
{
  kFingers,  ///< the fingers slip: the scale of the commands shifts by the slipped motion
  kChuck,    ///< the chuck stops and keeps its scale: the instrument follows again once the command returns
};

/** Limits of the commands to one instrument, and the gains of the force mode. Ranges of positions apply to the
 *  instrument: in the scale of the commands they shift by the slipped motion. */
struct DriveLimits
{
  BeyondLimit beyond = BeyondLimit::kRefuse;
  std::optional<Interval> insertion;  ///< range of the insertion; empty: plus and minus the instrument's length [m]
  Interval rotation{-2000.0 * M_PI, 2000.0 * M_PI};  ///< range of the rotation; 1000 turns by default [rad]
  Interval pressure{-1.1e5, 1e7};                    ///< range of the pressure: from a vacuum to beyond any burst [Pa]
  double speed = 1.0;                                ///< largest insertion speed [m/s]
  double acceleration = 10.0;           ///< largest acceleration of moves and of the velocity and force modes [m/s²]
  double turning_speed = 60.0;          ///< largest turning speed [rad/s]
  double turning_acceleration = 600.0;  ///< as `acceleration`, of the rotation [rad/s²]
  double step = kLargestInsertionStep;  ///< largest difference of two consecutive positions of a stream [m]
  double turn = kLargestRotationStep;   ///< as `step`, of the rotation [rad]
  double approach_speed = 0.1;          ///< speed of a move, and towards the first position of a stream [m/s]
  double approach_turning_speed = 3.0;  ///< as `approach_speed`, of the rotation [rad/s]
  std::optional<double> force;          ///< largest commanded force; empty: that of the grip [N]
  std::optional<double> torque;         ///< largest commanded torque; empty: that of the grip [N·m]
  double force_gain = 0.02;             ///< speed per difference of the force in the force mode [m/(s·N)]
  double torque_gain = 2000.0;          ///< turning speed per difference of the torque [rad/(s·N·m)]
  double time_out = 0.2;                ///< age at which a command, and the claim of its sender, end [s]

  bool operator==(const DriveLimits& other) const;
  bool operator!=(const DriveLimits& other) const { return !(*this == other); }

  /** Limits in which the empty values are replaced.
   *  @param length of the instrument [m]
   *  @param grip_force, grip_torque force and torque of the grip [N], [N·m] */
  DriveLimits completed(double length, double grip_force, double grip_torque) const;
};

}  // namespace endovascular_sim::drive
