#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive_limits.h"
#include "robot/robot_model.h"

namespace endovascular_sim::robot
{

/** Motions of an instrument, in the order of its joints. */
enum class Motion
{
  kInsertion,  ///< [m]
  kRotation,   ///< [rad]
  kPressure,   ///< at the inflator of its balloon [Pa]
};

/** Connection of a joint to a motion of an instrument: motion = ratio · position of the joint + offset, through a play.
 */
struct JointLink
{
  std::string joint;
  std::string instrument;
  Motion motion = Motion::kInsertion;
  double ratio = 1.0;     ///< motion per motion of the joint, e.g. m/m, m/rad, rad/rad; negative: opposite direction
  double offset = 0.0;    ///< motion at the position zero of the joint [m, rad, Pa]
  double backlash = 0.0;  ///< full width of the play, at the instrument [m, rad, Pa]

  double toMotion(double position) const { return ratio * position + offset; }
  double toPosition(double motion) const { return (motion - offset) / ratio; }
};

/** Error of a link. */
struct LinkFault
{
  std::size_t link = 0;  ///< index
  std::string key;       ///< key of the link, e.g. "joint"
  std::string remedy;
};

/** First error of the links that the robot reveals: a joint that is missing, fixed, a mimic or without motion, or one
 *  that is beyond its limits at the start.
 *  @param starts motions at the start of the scene, one per link */
std::optional<LinkFault> findFault(const RobotModel& model, const std::vector<JointLink>& links,
                                   const std::vector<double>& starts);

/** Limits of an instrument's commands with those of a joint: the ranges intersect, the smaller speed and force apply.
 *  The pressure has a range only.
 *  @param limits of the instrument, completed ones (DriveLimits::completed())
 *  @param start motion at the start of the scene, which stays within the range */
drive::DriveLimits withJoint(drive::DriveLimits limits, const JointLink& link, const Joint& joint, double start);

/** Movable joints that neither a link nor a mimic moves. */
std::vector<std::string> idleJoints(const RobotModel& model, const std::vector<JointLink>& links);

}  // namespace endovascular_sim::robot
