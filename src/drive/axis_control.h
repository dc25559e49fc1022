#pragma once

#include <limits>

#include "drive/drive_limits.h"
#include "drive/trapezoidal_move.h"

namespace endovascular_sim::drive
{

/** Limits of one axis, insertion [m, N] or rotation [rad, N·m]. */
struct AxisLimits
{
  Interval range;
  double speed = 0.0;         ///< largest speed [1/s]
  double acceleration = 0.0;  ///< largest acceleration [1/s²]
  double move_speed = 0.0;    ///< largest speed of a move [1/s]
  double gain = 0.0;          ///< speed per difference of the effort
};

/** Measured state of one axis. */
struct AxisFeedback
{
  double reached = 0.0;  ///< position that the instrument has reached, in the scale of the commands
  double effort = 0.0;   ///< force or torque with which the instrument resists
  double slipped = 0.0;  ///< scale of the commands minus position of the instrument
  Interval stops{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  ///< positions between the present stops of the instrument, in the scale of the commands
};

/** Modes of one axis in which the axis itself determines its positions: velocity, effort and move. A stream of
 * positions is the matter of CommandGate; it replaces the position with follow().
 *
 *  The setpoint is a function of the commands, the simulated time and the feedback only. In every mode the instrument
 *  stays within the range, and the setpoint between the stops. Its acceleration stays below the limit, except at the
 *  ends of the range, at stops, and in follow(). */
class AxisControl
{
public:
  AxisControl(const AxisLimits& limits, double position) : limits_(limits), position_(position), move_(position) {}

  /** Takes over a position of another source; the axis is then at rest there. */
  void follow(double position);
  /** Brakes to rest. */
  void hold();
  /** Moves with a velocity until the next command. */
  void setVelocity(double velocity);
  /** Moves with a velocity in proportion to the difference of an effort and the measured one (admittance). */
  void setEffort(double effort);
  /** Moves to a goal, at most to the end of the range or to a stop. */
  void moveTo(double goal);

  /** Advances by a step. @return setpoint at its end */
  double next(double dt, const AxisFeedback& feedback);

  double position() const { return position_; }  ///< setpoint of the last step
  double velocity() const { return velocity_; }  ///< its velocity
  double goal() const { return mode_ == Mode::kMove ? move_.goal() : position_; }
  bool isMoving() const { return mode_ == Mode::kMove; }  ///< true during a move
  bool isStopped() const { return is_stopped_; }  ///< true if a stop or the end of the range holds the last step back

  /** Saves or loads all data that change. @throws ArchiveError for invalid ones */
  void archive(Archive& archive);

private:
  enum class Mode
  {
    kVelocity,
    kEffort,
    kMove,
  };

  double wantedVelocity(double effort) const;
  double permitted(double position, const AxisFeedback& feedback) const;
  void integrate(double dt, const AxisFeedback& feedback);

  AxisLimits limits_;
  Mode mode_ = Mode::kVelocity;
  double target_ = 0.0;  ///< commanded velocity or effort
  double position_;
  double velocity_ = 0.0;
  bool is_stopped_ = false;
  TrapezoidalMove move_;
  double move_time_ = 0.0;  ///< since the start of the move [s]
};

}  // namespace endovascular_sim::drive
