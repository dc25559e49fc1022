#include <cmath>

#include "common/text/format.h"
#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

const std::vector<std::string> kDrags = {"none", "soft", "all"};  // in the order of FlowDrag

constexpr double kSameRatio = 1e-9;    // of a ratio that is whole up to rounding
constexpr double kLongestStep = 0.02;  // of the flow: the pulse has some ten samples in its rise [s]

}  // namespace

void visitFlow(yaml::Fields& fields, FlowScene& flow)
{
  if (fields.reading() && !fields.has("circulation"))
    fields.reject("circulation", "missing; name one of config/hemodynamics, e.g. adult, or the path of a file");
  fields.map("circulation", [&flow](yaml::Fields& keys) { flow::visitCirculation(keys, flow.circulation); });
  if (fields.reading())
  {
    flow.heart_rate = flow.circulation.heart.rate;
    flow.mean_pressure = flow.circulation.mean_pressure;
  }
  fields.number("time_step", flow.time_step, quantities::kTimeStep, Range::positiveUpTo(kLongestStep));
  fields.number("heart_rate", flow.heart_rate, quantities::kHeartRate, Range::between(1.0 / 3.0, 5.0));
  fields.number("mean_pressure", flow.mean_pressure, quantities::kBloodPressure, Range::between(2e3, 4e4));
  fields.boolean("hyperaemia", flow.hyperaemia);
  fields.option("drag", flow.drag, kDrags);
}

void checkFlow(const yaml::Fields& fields, const Scene& scene)
{
  if (!scene.flow)
    return;
  if (!scene.vessel)
    fields.reject("flow", "needs the tree of a vessel; give vessel, or remove flow");
  if (!scene.introducer)
    fields.reject("flow", "needs an introducer, through which instruments enter; set introducer: true");
  if (!scene.solver.traits().streams)
    fields.reject("solver.scheme", "'" + scene.solver.scheme + "' has no drag of a stream; set solver.scheme: kkt");
  if (scene.loads.fluid_density > 0.0)
    fields.reject("loads.fluid_density", "has a drag of blood at rest beside that of the flow; remove it");
  const double ratio = scene.flow->time_step / scene.solver.time_step;
  if (ratio < 1.0 - kSameRatio || std::abs(ratio - std::round(ratio)) > kSameRatio * ratio)
    fields.reject("flow.time_step",
                  formatted("%g s is no multiple of solver.time_step, %g s; give e.g. %g", scene.flow->time_step,
                            scene.solver.time_step, std::max(1.0, std::round(ratio)) * scene.solver.time_step));
}

}  // namespace endovascular_sim::scene
