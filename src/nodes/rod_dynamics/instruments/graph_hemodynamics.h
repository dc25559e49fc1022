#pragma once

#include <string>

#include "endovascular_sim/HemodynamicControls.h"
#include "endovascular_sim/SetHemodynamics.h"
#include "flow/coupling/flow_source.h"
#include "nodes/rod_dynamics/instruments/graph_controls.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

/** Heart rate, mean pressure and hyperaemia, part of GraphControls. */
struct CirculationPart
{
  using Controls = flow::FlowControls;
  using Message = HemodynamicControls;
  using Service = SetHemodynamics;
  static constexpr auto kTopic = names::kHemodynamicControls;
  static constexpr auto kService = names::kSetHemodynamics;
  static constexpr auto kNoun = "the circulation";

  static Controls of(const session::Session& session) { return session.flowControls(); }
  static void set(session::Session& session, const Controls& controls) { session.setFlowControls(controls); }
  /** Controls with the changes of a request. @param refusal set to the reason of a refusal */
  static Controls changed(Controls controls, const Service::Request& request, std::string& refusal);
  static std::string describe(const Controls& controls);
  static void toMessage(const Controls& controls, Message& message);
};

/** Circulation in the graph: service hemodynamics/set, topic hemodynamics/controls. */
using GraphHemodynamics = GraphControls<CirculationPart>;

}  // namespace endovascular_sim::nodes
