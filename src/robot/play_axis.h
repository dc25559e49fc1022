#pragma once

#include <cstddef>
#include <optional>

#include "drive/joint_command.h"
#include "robot/joint_link.h"

namespace endovascular_sim::robot
{

/** True for velocities and forces. */
bool isByRate(drive::CommandKind kind);

/** True for positions relative to the last ones. */
bool isRelative(drive::CommandKind kind);

/** Motion of an instrument behind the play of its joint, in the unit of the motion. A motion without a joint has no
 *  play. */
struct PlayAxis
{
  std::optional<std::size_t> link;  ///< index of the joint's link
  double wanted = 0.0;              ///< motion of the joint that was commanded last
  double driving = 0.0;             ///< motion of the joint
  double driven = 0.0;              ///< motion of the instrument, as last commanded
  double setpoint = 0.0;            ///< motion of the instrument at the last step
  double rate = 0.0;                ///< commanded velocity, or the sign of the force
  bool engaged = false;             ///< true: a commanded velocity moves the instrument, not only the joint in its play

  /** Takes over a command to the joint.
   *  @param joint link of the joint
   *  @return value of the command to the instrument */
  double command(const JointLink& joint, drive::CommandKind kind, double value);

  /** Takes over the instrument's setpoint after a step.
   *  @param kind of the last command
   *  @param is_over true when that has timed out
   *  @param dt time since the last setpoint [s]
   *  @param play of the joint
   *  @return true if the joint has used up its play in this step */
  bool follow(double setpoint_of_step, drive::CommandKind kind, bool is_over, double dt, double play);
};

}  // namespace endovascular_sim::robot
