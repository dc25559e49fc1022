#include "nodes/rod_dynamics/instruments/graph_motion.h"

#include <cmath>

#include "common/text/format.h"
#include "nodes/conversions/motion_conversions.h"

namespace endovascular_sim::nodes
{

void MotionPart::set(session::Session& session, motion::MotionControls controls) const
{
  if (has_flow)
    controls.heart_rate = session.motionControls().heart_rate;
  session.setMotionControls(controls);
}

motion::MotionControls MotionPart::changed(motion::MotionControls controls, const SetMotion::Request& request,
                                           std::string& refusal) const
{
  if (!std::isnan(request.heart_rate))
    controls.heart_rate = request.heart_rate;
  if (!std::isnan(request.breathing_rate))
    controls.breathing_rate = request.breathing_rate;
  if (request.breath_hold >= 0)
    controls.breath_held = request.breath_hold == 1;
  refusal = motion::refusalOf(controls);
  if (has_flow && !std::isnan(request.heart_rate))
    refusal = std::string("the flow of blood drives the heart; set its rate with ") + names::kSetHemodynamics;
  if (request.breath_hold < -1 || request.breath_hold > 1)
    refusal = formatted("breath_hold is %d; must be 1, 0 or -1", static_cast<int>(request.breath_hold));
  return controls;
}

std::string MotionPart::describe(const motion::MotionControls& controls)
{
  return formatted("heart rate %g Hz from the next beat on, breathing rate %g Hz from the next breath on, %s",
                   controls.heart_rate, controls.breathing_rate,
                   controls.breath_held ? "breath held from the next end of an expiration on" : "breathing freely");
}

void MotionPart::toMessage(const motion::MotionControls& controls, MotionControls& message)
{
  nodes::toMessage(controls, message);
}

}  // namespace endovascular_sim::nodes
