#include "nodes/rod_dynamics/rod_publisher.h"

#include <algorithm>
#include <cmath>

#include "instrument/instrument.h"
#include "nodes/conversions/contrast_conversions.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/conversions/rod_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/rod_dynamics/instruments/instrument_observation.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/instrument_tip.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kVisualRate = 60.0;  ///< rate of the data for display [Hz]
constexpr std::uint32_t kStepQueue =
    10000;                             ///< 10 s of steps: a recorder that is stopped for a shorter time loses none
constexpr int kVisualQueue = 1000;     ///< data for display of as many steps
constexpr int kTreatmentQueue = 1000;  ///< the recorder must not lose an event

}  // namespace

RodPublisher::RodPublisher(ros::NodeHandle& node, const scene::Scene& scene, Pace pace)
  : visual_period_(static_cast<std::uint64_t>(std::max(1.0, std::floor(1.0 / (kVisualRate * scene.solver.time_step))))),
    last_step_(static_cast<std::uint64_t>(std::llround(scene.duration / scene.solver.time_step)))
{
  if (scene.fluoroscopy)
    pulses_.emplace(scene.fluoroscopy->rate, scene.solver.time_step);
  applied_ = node.advertise<DriveApplied>(names::kDriveApplied, kStepQueue);
  group_ = node.advertise<SessionSteps>(names::kSessionSteps,
                                        std::max(1U, kStepQueue / static_cast<std::uint32_t>(visual_period_)));
  const std::uint32_t visual_queue = pace == Pace::kRealTime ? 2 : kVisualQueue;
  visual_ = node.advertise<RodStateVisual>(names::kRodStateVisual, visual_queue);
  if (scene.motion)
    motion_ = node.advertise<MotionState>(names::kMotionState, visual_queue);
  if (scene.contrast)
    contrast_ = node.advertise<ContrastState>(names::kContrastState, visual_queue);
  if (simulation::hasBalloon(scene))
    treatment_ = node.advertise<TreatmentVisual>(names::kTreatmentVisual, kTreatmentQueue);
  applied_message_.insertion.resize(scene.instruments.size());
  applied_message_.rotation.resize(scene.instruments.size());
  applied_message_.pressure.resize(scene.instruments.size());
  applied_message_.hand_force.resize(scene.instruments.size());
  applied_message_.hand_torque.resize(scene.instruments.size());
  visual_message_.header.frame_id = names::kPatientFrame;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    frames_.push_back(
        scene.flow && instrument::pressureLineOf(driven.instrument) ? driven.instrument.name + names::kTipFrameOf : "");
}

void RodPublisher::publishStep(const simulation::Simulation& simulation, const std::vector<RenderedHand>& hands,
                               ros::Time now)
{
  now_ = now;
  const bool is_display = simulation.steps() % visual_period_ == 0;
  const bool is_visual = is_display || (pulses_ && pulses_->isPulse(simulation.steps()));
  const bool is_last = simulation.steps() == last_step_;
  // Events and the state at the scene's end are published without delay, so that no recording lacks them.
  const bool is_event = simulation.events().size() != treatment_message_.event.size() || is_last;
  publishApplied(simulation, hands);
  if (is_visual || is_last)
    publishGroup();
  if (is_visual && simulation.motion() != nullptr)
    publishMotion(simulation);
  if (is_visual && simulation.contrast() != nullptr)
    publishContrast(simulation);
  if (is_visual)
    publishVisual(simulation);
  if (treatment_ && (is_visual || is_event))
    publishTreatment(simulation);
  if (is_display)
    publishTips(simulation);
}

void RodPublisher::publishApplied(const simulation::Simulation& simulation, const std::vector<RenderedHand>& hands)
{
  const bool has_subscriber = applied_.getNumSubscribers() > 0;
  const bool has_recorder = group_.getNumSubscribers() > 0;
  if (!has_subscriber && !has_recorder)
    return;
  applied_message_.header.stamp = now_;
  applied_message_.step = simulation.steps() - 1;
  for (std::size_t k = 0; k < hands.size(); ++k)
  {
    applied_message_.insertion[k] = hands[k].command.insertion;
    applied_message_.rotation[k] = hands[k].command.rotation;
    applied_message_.pressure[k] = hands[k].command.pressure;
    applied_message_.hand_force[k] = hands[k].force;
    applied_message_.hand_torque[k] = hands[k].torque;
  }
  applied_message_.first_stale_pass = simulation.report().first_stale_pass;
  applied_message_.state_hash = simulation.stateHash();
  if (has_subscriber)
    applied_.publish(applied_message_);
  if (has_recorder)
    group_message_.steps.push_back(applied_message_);
}

void RodPublisher::publishGroup()
{
  if (group_message_.steps.empty())
    return;
  group_.publish(group_message_);
  group_message_.steps.clear();
}

void RodPublisher::reset()
{
  publishGroup();
  treatment_message_ = TreatmentVisual();
}

/** Publishes the motion of the patient, before the state of the instruments in it. */
void RodPublisher::publishMotion(const simulation::Simulation& simulation)
{
  motion_message_.header.frame_id = names::kPatientFrame;
  motion_message_.header.stamp = now_;
  motion_message_.step = simulation.steps() - 1;
  motion_message_.time = simulation.time();
  toMessage(simulation.motion()->patient(), motion_message_);
  motion_.publish(motion_message_);
}

/** Publishes the contrast medium, before the state of the instruments in it. */
void RodPublisher::publishContrast(const simulation::Simulation& simulation)
{
  contrast_message_.header.frame_id = names::kPatientFrame;
  contrast_message_.header.stamp = now_;
  toMessage(simulation, contrast_message_);
  contrast_.publish(contrast_message_);
}

void RodPublisher::publishVisual(const simulation::Simulation& simulation)
{
  visual_message_.header.stamp = now_;
  toMessage(simulation, visual_message_);
  visual_.publish(visual_message_);
}

void RodPublisher::publishTreatment(const simulation::Simulation& simulation)
{
  treatment_message_.header.frame_id = names::kPatientFrame;
  treatment_message_.header.stamp = now_;
  treatment_message_.step = simulation.steps() - 1;
  treatment_message_.time = simulation.time();
  toMessage(simulation, treatment_message_);
  treatment_.publish(treatment_message_);
}

void RodPublisher::publishTips(const simulation::Simulation& simulation)
{
  publishTip(simulation, static_cast<std::size_t>(simulation.state().reference), names::kTipFrame);
  for (std::size_t k = 0; k < frames_.size(); ++k)
    if (!frames_[k].empty())
      publishTip(simulation, k, frames_[k]);
}

void RodPublisher::publishTip(const simulation::Simulation& simulation, std::size_t instrument,
                              const std::string& frame)
{
  const geometry_msgs::Pose tip = tipPose(simulation, instrument);
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = now_;
  transform.header.frame_id = names::kPatientFrame;
  transform.child_frame_id = frame;
  transform.transform.translation.x = tip.position.x;
  transform.transform.translation.y = tip.position.y;
  transform.transform.translation.z = tip.position.z;
  transform.transform.rotation = tip.orientation;
  transforms_.sendTransform(transform);
}

}  // namespace endovascular_sim::nodes
