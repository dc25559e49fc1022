#include "common/text/format.h"
#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

constexpr Range kHeartRates{motion::kLeastHeartRate, motion::kLargestHeartRate, false, false, "20 to 300 per minute"};
constexpr Range kBreathingRates{motion::kLeastBreathingRate, motion::kLargestBreathingRate, false, false,
                                "1.8 to 60 per minute"};

}  // namespace

void visitMotion(yaml::Fields& fields, MotionScene& motion, const std::optional<FlowScene>& flow)
{
  if (fields.reading() && !fields.has("patient"))
    fields.reject("patient", "missing; name one of config/motion, e.g. adult, or the path of a file");
  fields.map("patient", [&motion](yaml::Fields& keys) { motion::visitMotion(keys, motion.patient); });
  if (fields.reading())
  {
    motion.heart_rate = flow ? flow->heart_rate : motion.patient.heart.rate;
    motion.breathing_rate = motion.patient.breathing.rate;
  }
  // The flow drives the heart: the text of the scene has one rate.
  if (fields.reading() || !flow)
    fields.number("heart_rate", motion.heart_rate, quantities::kHeartRate, kHeartRates);
  if (fields.reading() && flow && motion.heart_rate != flow->heart_rate)
    fields.reject("heart_rate", formatted("differs from that of the flow, %.4g Hz (%.4g per minute), which drives the "
                                          "heart; remove it, and set flow.heart_rate",
                                          flow->heart_rate, 60.0 * flow->heart_rate));
  fields.number("breathing_rate", motion.breathing_rate, quantities::kBreathingRate, kBreathingRates);
  fields.boolean("breath_held", motion.breath_held);
}

void checkMotion(const yaml::Fields& fields, const Scene& scene)
{
  if (!scene.motion)
    return;
  if (!scene.rollers.empty())
    fields.reject("motion", "rollers do not move with a patient; remove motion, or the rollers");
  if (!scene.vessel)
    fields.reject("motion", "needs a vessel with named coronary arteries; give vessel, or remove motion");
  if (!scene.introducer)
    fields.reject("motion", "needs an introducer, through which instruments enter; set introducer: true");
  if (!scene.solver.traits().moving_walls)
    fields.reject("solver.scheme",
                  "'" + scene.solver.scheme + "' has no wall that moves with motion; set solver.scheme: kkt");
}

}  // namespace endovascular_sim::scene
