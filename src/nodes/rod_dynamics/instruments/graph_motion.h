#pragma once

#include <string>

#include "endovascular_sim/MotionControls.h"
#include "endovascular_sim/SetMotion.h"
#include "motion/motion_controls.h"
#include "nodes/rod_dynamics/instruments/graph_controls.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

/** Heart rate, breathing rate and breath-hold, part of GraphControls. */
struct MotionPart
{
  using Controls = motion::MotionControls;
  using Message = MotionControls;
  using Service = SetMotion;
  static constexpr auto kTopic = names::kMotionControls;
  static constexpr auto kService = names::kSetMotion;
  static constexpr auto kNoun = "the patient's motion";

  bool has_flow = false;  ///< true: the flow of blood drives the heart

  static Controls of(const session::Session& session) { return session.motionControls(); }
  void set(session::Session& session, Controls controls) const;
  /** Controls with the changes of a request. @param refusal set to the reason of a refusal */
  Controls changed(Controls controls, const Service::Request& request, std::string& refusal) const;
  static std::string describe(const Controls& controls);
  static void toMessage(const Controls& controls, Message& message);
};

/** Motion of the patient in the graph: service motion/set, topic motion/controls. */
using GraphMotion = GraphControls<MotionPart>;

}  // namespace endovascular_sim::nodes
