#pragma once

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::drive
{

/** Motion of one axis to a goal in the shortest time, with limited speed and acceleration, as a function of time.
 *
 *  The speed changes linearly to a cruising speed, stays there, and changes linearly to zero at the goal. An axis that
 *  moves already begins with its own speed; where it cannot stop before the goal, or moves away from it, it turns back.
 */
class TrapezoidalMove
{
public:
  /** Rest at a position. */
  explicit TrapezoidalMove(double position = 0.0) : start_(position), goal_(position) {}

  /** @param start, velocity position and velocity at time 0
   *  @param speed, acceleration limits, positive */
  TrapezoidalMove(double start, double velocity, double goal, double speed, double acceleration);

  /** Position at a time since the start [s]; the goal itself from the end on. */
  double position(double time) const;
  /** Velocity at a time since the start [s]. */
  double velocity(double time) const;

  double goal() const { return goal_; }
  double duration() const { return ramp_ + cruise_ + braking_; }  ///< [s]

  /** Saves or loads the move. @throws ArchiveError for numbers that are not finite */
  void archive(Archive& archive);

private:
  double start_;
  double goal_;
  double direction_ = 1.0;  ///< of the cruise, 1 or −1
  double velocity_ = 0.0;   ///< at the start, along the direction
  double cruising_ = 0.0;   ///< cruising speed
  double ramp_ = 0.0;       ///< duration of the change to the cruising speed [s]
  double cruise_ = 0.0;     ///< [s]
  double braking_ = 0.0;    ///< [s]
};

}  // namespace endovascular_sim::drive
