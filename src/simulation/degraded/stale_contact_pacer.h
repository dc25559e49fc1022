#pragma once

#include "drive/hand_command.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** Paces the commanded motion while contact sets are missing, so that neither their loss nor their return causes a
 * jump.
 *
 *  A stale set covers a limited motion only. The motion brakes with limited jerk to a creep, which keeps sliding
 *  friction sliding, and stops where the cover ends. With fresh sets the missed motion is released again.
 *
 *  The pace p scales the commanded motion. While braking, |p''| ≤ v²/D², with the earlier speed v and the remaining
 *  travel D: the smallest bound that stops in time. While recovering, |p''| ≤ ω². The missed motion m is released with
 *  the speed q, q'' = ω²(m/τ − q) − 2ωq'. With τ = 27/(4ω) all roots are real. m/τ is limited to 5 mm/s plus a fifth of
 *  v. Without a missing set every number passes unchanged. Pressures are never paced. */
class StaleContactPacer
{
public:
  /** @param cover motion of the wire that a stale contact set covers [m]
   *  @param time_step duration of a step [s] */
  StaleContactPacer(double cover, double time_step) : cover_(cover), dt_(time_step) {}

  /** Paces the motion of one step.
   *  @param wanted commanded motion of the step, including all missed motion
   *  @param stale true when the newest contact set is stale
   *  @return motion that the step performs */
  drive::HandIncrement follow(const drive::HandIncrement& wanted, bool stale);

  /** Largest travel without a fresh set [m]. */
  double reach() const;

  /** Adds to the missed motion the part of the last returned motion that was not performed. */
  void miss(const drive::HandIncrement& motion);

  void archive(Archive& archive);  ///< saves or loads the state

private:
  /** State of one direction of motion; units m or rad. */
  struct Channel
  {
    double missed = 0.0;        ///< commanded but not yet performed motion
    double release = 0.0;       ///< speed at which the missed motion is released [1/s]
    double release_rate = 0.0;  ///< time derivative of the release [1/s²]

    double follow(double wanted, double pace, bool stale, double most, double dt);
    void archive(Archive& archive);
  };

  void brake();
  void approach(double target, double jerk);
  bool isAtRest() const
  {
    return pace_ == 1.0 && pace_rate_ == 0.0 && insertion_.missed == 0.0 && rotation_.missed == 0.0;
  }

  double cover_;
  double dt_;
  Channel insertion_;
  Channel rotation_;
  double pace_ = 1.0;
  double pace_rate_ = 0.0;    ///< time derivative of the pace [1/s]
  double jerk_ = 0.0;         ///< bound of the pace's second derivative while braking [1/s²]
  double speed_ = 0.0;        ///< smoothed speed of the motion before the first stale set [m/s]
  double last_travel_ = 0.0;  ///< travel of the last step [m]
  double travel_ = 0.0;       ///< travel since the last fresh set [m]
};

}  // namespace endovascular_sim::simulation
