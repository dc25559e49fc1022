#pragma once

#include "drive/drive_limits.h"
#include "drive/hand_command.h"
#include "scene/model/scene.h"
#include "simulation/degraded/stale_contact_pacer.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** Handle of one instrument: its position, and force and torque on the user's hand. */
struct HandState
{
  double insertion = 0.0;  ///< tip beyond the introducer; negative: outside [m]
  double rotation = 0.0;   ///< rotation of the handle [rad]
  double force = 0.0;      ///< axial force on the hand, positive where it resists pushing [N]
  double torque = 0.0;     ///< torque that the hand holds [N·m]
  double pressure = 0.0;   ///< pressure at the inflator of the instrument's balloon [Pa]
};

/** Insertions between which an instrument can move behind an introducer [m]. */
struct HandleRange
{
  double commanded;  ///< least one to which commands lead
  double least;
  double most;  ///< may lie below the least one: then the instrument stays there
};

/** Part of the commands of a hand that reaches its instrument. The hand moves at most at the speed of its drive. Where
 *  the instrument resists with more than the limits of the drive, fingers slip and a chuck stops (drive::Grip). */
class Handle
{
public:
  Handle(const scene::DriveScene& drive, StaleContactPacer pacer)
    : slips_(drive.grip == drive::Grip::kFingers),
      speed_(drive.limits.speed),
      turning_speed_(drive.limits.turning_speed),
      force_limit_(drive.force_limit),
      torque_limit_(drive.torque_limit),
      pacer_(pacer)
  {
  }

  /** Commanded motion in a step.
   *  @param range null without an introducer: then only rotations pass
   *  @param stale the newest contact set is: the motion is paced
   *  @param dt of the step [s] */
  drive::HandIncrement wanted(const HandState& now, const drive::HandCommand& command, const HandleRange* range,
                              bool stale, double dt);

  /** Part of a wanted motion that reaches the instrument in a sub-step; the grip is updated.
   *  @param dt of the sub-step [s] */
  drive::HandIncrement allowed(const HandState& now, const drive::HandIncrement& wanted, const HandleRange& range,
                               double dt);

  /** Takes over a slip that the solution of the sub-step has shown: the grip is as loose as that.
   *  @param before, wanted, reached insertions at its beginning and end [m] */
  void noteSlip(double before, double wanted, double reached);

  /** Motion that fingers have slipped: the scale of the commands minus the position; 0 for a chuck. */
  const drive::HandIncrement& slipped() const { return slipped_; }

  StaleContactPacer& pacer() { return pacer_; }

  void archive(Archive& archive);

private:
  bool slips_;            ///< fingers; else a chuck
  double speed_;          ///< largest [m/s]
  double turning_speed_;  ///< largest [rad/s]
  double force_limit_;    ///< [N]
  double torque_limit_;   ///< [N·m]
  StaleContactPacer pacer_;
  drive::HandIncrement slipped_;
  double grip_ = 1.0;          ///< while pushing, 1 firm to 0 slipping
  double turning_grip_ = 1.0;  ///< while turning
};

}  // namespace endovascular_sim::simulation
