#include "robot/joint_link.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/text/format.h"

namespace endovascular_sim::robot
{
namespace
{

constexpr double kSamePosition = 1e-9;  // of joints [m, rad]

/** Error of a joint that cannot be commanded; empty if it can. */
std::string faultOf(const RobotModel& model, const std::string& name)
{
  const Joint* joint = model.find(name);
  if (joint == nullptr)
    return "the URDF " + model.file + " has no joint '" + name + "'; its movable joints are " + model.movableNames();
  if (!joint->isMovable())
    return "joint '" + name + "' of " + model.file + " is " +
           (joint->kind == JointKind::kFixed ? "fixed" : "planar or floating") + "; its movable joints are " +
           model.movableNames();
  if (joint->mimic)
    return "joint '" + name + "' of " + model.file + " mimics '" + joint->mimic->joint + "'; give that joint instead";
  if (joint->speed && *joint->speed == 0.0)
    return "joint '" + name + "' of " + model.file + " (line " + std::to_string(joint->line) +
           ") has the limit velocity=\"0\" and cannot move; give its largest speed";
  if (joint->effort && *joint->effort == 0.0)
    return "joint '" + name + "' of " + model.file + " (line " + std::to_string(joint->line) +
           ") has the limit effort=\"0\" and cannot push; give its largest force or torque";
  if (joint->range && joint->range->low == joint->range->high)
    return "joint '" + name + "' of " + model.file + " (line " + std::to_string(joint->line) +
           ") has equal limits lower and upper and cannot move; give its range";
  return "";
}

}  // namespace

std::optional<LinkFault> findFault(const RobotModel& model, const std::vector<JointLink>& links,
                                   const std::vector<double>& starts)
{
  for (std::size_t k = 0; k < links.size(); ++k)
  {
    const JointLink& link = links[k];
    const std::string fault = faultOf(model, link.joint);
    if (!fault.empty())
      return LinkFault{k, "joint", fault};
    const Joint& joint = *model.find(link.joint);
    const double position = link.toPosition(starts[k]);
    if (joint.range && (position < joint.range->low - kSamePosition || position > joint.range->high + kSamePosition))
      return LinkFault{k, "offset",
                       "puts joint '" + link.joint + "' at " + shortNumber(position) +
                           " at the start, beyond its limits " + shortNumber(joint.range->low) + " to " +
                           shortNumber(joint.range->high) + " in " + model.file + "; an offset of " +
                           shortNumber(starts[k] - link.ratio * joint.range->low) + " puts it at its lower limit"};
  }
  return std::nullopt;
}

drive::DriveLimits withJoint(drive::DriveLimits limits, const JointLink& link, const Joint& joint, double start)
{
  const double ratio = std::abs(link.ratio);
  drive::Interval* range = link.motion == Motion::kInsertion  ? &*limits.insertion
                           : link.motion == Motion::kRotation ? &limits.rotation
                                                              : &limits.pressure;
  if (joint.range)
  {
    double low = link.toMotion(joint.range->low);
    double high = link.toMotion(joint.range->high);
    if (low > high)
      std::swap(low, high);
    low = std::min(low + 0.5 * link.backlash, start);
    high = std::max(high - 0.5 * link.backlash, start);
    *range = {std::max(range->low, low), std::min(range->high, high)};
  }
  if (link.motion == Motion::kInsertion)
  {
    limits.speed = std::min(limits.speed, ratio * joint.speed.value_or(HUGE_VAL));
    limits.approach_speed = std::min(limits.approach_speed, limits.speed);
    limits.force = std::min(*limits.force, joint.effort.value_or(HUGE_VAL) / ratio);
  }
  else if (link.motion == Motion::kRotation)
  {
    limits.turning_speed = std::min(limits.turning_speed, ratio * joint.speed.value_or(HUGE_VAL));
    limits.approach_turning_speed = std::min(limits.approach_turning_speed, limits.turning_speed);
    limits.torque = std::min(*limits.torque, joint.effort.value_or(HUGE_VAL) / ratio);
  }
  return limits;
}

std::vector<std::string> idleJoints(const RobotModel& model, const std::vector<JointLink>& links)
{
  std::vector<std::string> idle;
  for (const Joint& joint : model.joints)
    if (joint.isMovable() && !joint.mimic &&
        std::none_of(links.begin(), links.end(), [&](const JointLink& link) { return link.joint == joint.name; }))
      idle.push_back(joint.name);
  return idle;
}

}  // namespace endovascular_sim::robot
