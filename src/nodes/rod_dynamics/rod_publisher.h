#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionSteps.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "fluoroscopy/angiography/pulse_train.h"
#include "nodes/rod_dynamics/control/pace.h"
#include "nodes/rod_dynamics/instruments/hand_force_renderer.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Publisher of the rod's state: used input at every step, in groups for the recorder, and data for display at about
 *  60 Hz and at every pulse of the X-ray system. */
class RodPublisher
{
public:
  /** @param pace in which every message must arrive, except in real time, where readers use the newest data */
  RodPublisher(ros::NodeHandle& node, const scene::Scene& scene, Pace pace);

  /** Publishes a step: used input, rendered forces and state hash; at its rate also the data for display.
   *  @param hands one per instrument */
  void publishStep(const simulation::Simulation& simulation, const std::vector<RenderedHand>& hands, ros::Time now);

  /** Publishes the steps that wait for the rest of their group. Call it whenever no step follows soon. */
  void publishGroup();

  /** Begins a new run. */
  void reset();

  /** Reports whether session/steps or drive/applied has a subscriber. */
  bool isRecorded() const { return group_.getNumSubscribers() > 0 || applied_.getNumSubscribers() > 0; }

private:
  void publishApplied(const simulation::Simulation& simulation, const std::vector<RenderedHand>& hands);
  void publishMotion(const simulation::Simulation& simulation);
  void publishContrast(const simulation::Simulation& simulation);
  void publishVisual(const simulation::Simulation& simulation);
  void publishTreatment(const simulation::Simulation& simulation);
  void publishTips(const simulation::Simulation& simulation);
  void publishTip(const simulation::Simulation& simulation, std::size_t instrument, const std::string& frame);

  std::uint64_t visual_period_;  ///< interval of the data for display, number of steps of a group [steps]
  /** Pulses of the X-ray system, whose states are published too; empty without fluoroscopy. */
  std::optional<fluoroscopy::PulseTrain> pulses_;
  std::uint64_t last_step_;          ///< last step of the scene's duration
  std::vector<std::string> frames_;  ///< of the tip of each instrument; empty unless its pressure is published
  ros::Publisher applied_, group_, visual_, treatment_, motion_, contrast_;
  tf2_ros::TransformBroadcaster transforms_;
  ros::Time now_;  ///< time of the last step
  DriveApplied applied_message_;
  SessionSteps group_message_;
  RodStateVisual visual_message_;
  MotionState motion_message_;
  ContrastState contrast_message_;
  TreatmentVisual treatment_message_;
};

}  // namespace endovascular_sim::nodes
