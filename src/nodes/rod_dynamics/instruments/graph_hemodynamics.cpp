#include "nodes/rod_dynamics/instruments/graph_hemodynamics.h"

#include <cmath>

#include "common/text/format.h"
#include "nodes/conversions/flow_conversions.h"

namespace endovascular_sim::nodes
{

flow::FlowControls CirculationPart::changed(flow::FlowControls controls, const SetHemodynamics::Request& request,
                                            std::string& refusal)
{
  if (!std::isnan(request.heart_rate))
    controls.heart_rate = request.heart_rate;
  if (!std::isnan(request.mean_pressure))
    controls.mean_pressure = request.mean_pressure;
  if (request.hyperaemia >= 0)
    controls.hyperaemia = request.hyperaemia == 1;
  refusal = flow::refusalOf(controls);
  if (request.hyperaemia < -1 || request.hyperaemia > 1)
    refusal = formatted("hyperaemia is %d; must be 1, 0 or -1", static_cast<int>(request.hyperaemia));
  return controls;
}

std::string CirculationPart::describe(const flow::FlowControls& controls)
{
  return formatted("heart rate %g Hz, mean pressure %g Pa, %s, from the next step on", controls.heart_rate,
                   controls.mean_pressure, controls.hyperaemia ? "hyperaemia" : "no hyperaemia");
}

void CirculationPart::toMessage(const flow::FlowControls& controls, HemodynamicControls& message)
{
  nodes::toMessage(controls, message);
}

}  // namespace endovascular_sim::nodes
