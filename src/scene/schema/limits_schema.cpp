#include <limits>

#include "scene/schema/scene_schema.h"

// Schema of the limits of a drive.

namespace endovascular_sim::scene
{
namespace
{

const std::vector<std::string> kBeyond = {"refuse", "clamp"};  // order of drive::BeyondLimit

/** Schema of an interval [low, high]. */
void visitInterval(yaml::Fields& fields, const std::string& key, drive::Interval& interval, const Quantity& quantity)
{
  double values[2] = {interval.low, interval.high};
  fields.numbers(key, values, 2, quantity);
  interval = {values[0], values[1]};
  if (fields.reading() && interval.low > interval.high)
    fields.reject(key, "has its limits in the wrong order; give [lowest, highest]");
}

/** Schema of a number without which another key applies. */
void visitOptional(yaml::Fields& fields, const std::string& key, std::optional<double>& value, const Quantity& quantity)
{
  double number = value.value_or(std::numeric_limits<double>::quiet_NaN());
  fields.optionalNumber(key, number, quantity, Range::positive());
  if (fields.reading() && fields.has(key))
    value = number;
}

}  // namespace

void visitLimits(yaml::Fields& fields, drive::DriveLimits& limits, bool balloon)
{
  fields.option("beyond", limits.beyond, kBeyond);
  if (fields.reading() ? fields.has("insertion") : limits.insertion.has_value())
  {
    if (!limits.insertion)
      limits.insertion.emplace();
    visitInterval(fields, "insertion", *limits.insertion, quantities::kInsertion);
  }
  visitInterval(fields, "rotation", limits.rotation, quantities::kRotationRange);
  if (balloon)
    visitInterval(fields, "pressure", limits.pressure, quantities::kPressureRange);
  else if (fields.reading() && fields.has("pressure"))
    fields.reject("pressure", "requires a balloon; use a balloon_catheter, or remove it");
  fields.number("speed", limits.speed, quantities::kSpeedLimit, Range::positive());
  fields.number("acceleration", limits.acceleration, quantities::kAcceleration, Range::positive());
  fields.number("turning_speed", limits.turning_speed, quantities::kAngularSpeed, Range::positive());
  fields.number("turning_acceleration", limits.turning_acceleration, quantities::kAngularAcceleration,
                Range::positive());
  fields.number("step", limits.step, quantities::kInsertion, Range::positive());
  fields.number("turn", limits.turn, quantities::kAngle, Range::positive());
  fields.number("approach_speed", limits.approach_speed, quantities::kSpeed, Range::positive());
  fields.number("approach_turning_speed", limits.approach_turning_speed, quantities::kAngularSpeed, Range::positive());
  visitOptional(fields, "force", limits.force, quantities::kForceLimit);
  visitOptional(fields, "torque", limits.torque, quantities::kTorqueLimit);
  fields.number("force_gain", limits.force_gain, quantities::kForceGain, Range::positive());
  fields.number("torque_gain", limits.torque_gain, quantities::kTorqueGain, Range::positive());
  fields.number("time_out", limits.time_out, quantities::kReaction, Range::positive());
}

}  // namespace endovascular_sim::scene
