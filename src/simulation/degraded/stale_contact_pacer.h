#pragma once

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** What the hand asks for at one step. */
struct HandCommand
{
  double insertion = 0.0;  ///< [m]
  double rotation = 0.0;   ///< [rad]
  double pressure = 0.0;   ///< at the inflator of its balloon [Pa]
};

/** Paces the hand while contact sets fail to come, so that neither their absence nor their return is felt as a jump.
 *
 *  An old set covers only so much motion. The hand brakes with limited jerk to a creep that keeps sliding friction
 *  sliding, and stops where the cover ends; afterwards it makes up for what it missed. The pace p of the hand obeys
 *  |p''| ≤ v²/D² while braking (v its speed before, D the travel left), which is the least that comes to rest in time,
 *  and |p''| ≤ ω² while recovering; what was missed is released at the speed q with q'' = ω²(missed/τ − q) − 2ωq', with
 *  τ = 27/(4ω), where all roots are real, and missed/τ limited to 5 mm/s and a fifth of v.
 *  While no set has failed it passes every number on unchanged; a pressure is never paced. */
class StaleContactPacer
{
public:
  /** @param cover motion of the wire that an old contact set covers [m]
   *  @param time_step [s] */
  StaleContactPacer(double cover, double time_step) : cover_(cover), dt_(time_step) {}

  /** @param wanted motion of this step, with all that was missed before
   *  @param blind the newest contact set is an old one
   *  @return the motion of this step */
  HandCommand follow(const HandCommand& wanted, bool blind);

  /** Travel that may be made without a fresh set [m]. */
  double reach() const;

  /** What of the last motion given was not made after all. */
  void miss(const HandCommand& motion);

  void archive(Archive& archive);  ///< saves or loads all that changes

private:
  /** One direction of motion; units m or rad. */
  struct Channel
  {
    double missed = 0.0;
    double release = 0.0;       ///< speed at which it is made up for [1/s]
    double release_rate = 0.0;  ///< [1/s²]

    double follow(double wanted, double pace, bool blind, double most, double dt);
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
  double pace_rate_ = 0.0;  ///< [1/s]
  double jerk_ = 0.0;       ///< of the pace while braking [1/s²]
  double speed_ = 0.0;      ///< of the hand before, smoothed [m/s]
  double last_ = 0.0;       ///< travel of the last step [m]
  double travel_ = 0.0;     ///< since the last fresh set [m]
};

}  // namespace endovascular_sim::simulation
