#include "nodes/rod_dynamics/rod_publisher.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "endovascular_sim/OperatingState.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/joint_state_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "results/run_result.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kVisualRate = 60.0;  ///< rate of the data for display [Hz]
constexpr int kStepQueue = 10000;     ///< 10 s of steps: a recorder that is stopped for a shorter time loses none
constexpr int kTreatmentQueue = 100;  ///< the recorder must not lose an event
constexpr int kHandQueue = 1;         ///< the device uses the newest force only

}  // namespace

RodPublisher::RodPublisher(ros::NodeHandle& node, const scene::Scene& scene)
  : visual_period_(static_cast<std::uint64_t>(std::max(1.0, std::floor(1.0 / (kVisualRate * scene.solver.time_step))))),
    last_step_(static_cast<std::uint64_t>(std::llround(scene.duration / scene.solver.time_step)))
{
  for (const scene::DrivenInstrument& driven : scene.instruments)
  {
    const std::string instrument = names::kInstruments + driven.instrument.name;
    hand_.push_back(node.advertise<sensor_msgs::JointState>(instrument + names::kMeasuredJs, kHandQueue));
    has_balloon_.push_back(driven.instrument.balloon.has_value());
    operating_.push_back(node.advertise<OperatingState>(instrument + names::kOperatingState, 1, true));
  }
  applied_ = node.advertise<DriveApplied>(names::kDriveApplied, kStepQueue);
  visual_ = node.advertise<RodStateVisual>(names::kRodStateVisual, 2);
  if (simulation::hasBalloon(scene))
    treatment_ = node.advertise<TreatmentVisual>(names::kTreatmentVisual, kTreatmentQueue);
  applied_message_.insertion.resize(hand_.size());
  applied_message_.rotation.resize(hand_.size());
  applied_message_.pressure.resize(hand_.size());
  applied_message_.hand_force.resize(hand_.size());
  applied_message_.hand_torque.resize(hand_.size());
  visual_message_.header.frame_id = names::kPatientFrame;
}

void RodPublisher::publishHands(const std::vector<RenderedHand>& hands, double share)
{
  hand_message_.header.stamp = ros::Time::now();
  for (std::size_t k = 0; k < hand_.size(); ++k)
  {
    if (hand_[k].getNumSubscribers() == 0)
      continue;
    const simulation::HandCommand& command = hands[k].command;
    toMessage(has_balloon_[k], command.insertion, command.rotation, command.pressure, share * hands[k].force,
              share * hands[k].torque, hand_message_);
    hand_[k].publish(hand_message_);
  }
}

void RodPublisher::publishStep(const simulation::Simulation& simulation, const std::vector<RenderedHand>& hands)
{
  publishHands(hands, 1.0);
  applied_message_.header.stamp = hand_message_.header.stamp;
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
  applied_.publish(applied_message_);
  const bool is_visual = simulation.steps() % visual_period_ == 0;
  // Events and the state at the scene's end are published without delay, so that no recording lacks them.
  const bool is_event =
      simulation.events().size() != treatment_message_.event.size() || simulation.steps() == last_step_;
  if (is_visual)
    publishVisual(simulation);
  if (treatment_ && (is_visual || is_event))
    publishTreatment(simulation);
  if (is_visual)
    publishTip(simulation);
}

void RodPublisher::publishVisual(const simulation::Simulation& simulation)
{
  const rod::State& state = simulation.state();
  const rod::Discretisation& wire = simulation.discretisation();
  RodStateVisual& message = visual_message_;
  message.header.stamp = hand_message_.header.stamp;
  message.step = simulation.steps() - 1;
  message.time = simulation.time();
  message.insertion.clear();
  message.rotation.clear();
  message.hand_force.clear();
  message.hand_torque.clear();
  message.pressure.clear();
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    const simulation::HandState hand = simulation.hand(k);
    message.insertion.push_back(hand.insertion);
    message.rotation.push_back(hand.rotation);
    message.hand_force.push_back(hand.force);
    message.hand_torque.push_back(hand.torque);
    message.pressure.push_back(hand.pressure);
  }
  const int first = results::firstInsertedNode(simulation);
  message.first_node = static_cast<std::uint32_t>(first);
  message.nodes.clear();
  message.radius.clear();
  message.contact_force.clear();
  for (int i = first; i < wire.nodes(); ++i)
  {
    message.nodes.push_back(toPoint(state.position[i]));
    message.radius.push_back(wire.radius[i]);
    message.contact_force.push_back(toVector(state.wall_force[i]));
  }
  visual_.publish(message);
}

void RodPublisher::publishTreatment(const simulation::Simulation& simulation)
{
  treatment_message_.header.frame_id = names::kPatientFrame;
  treatment_message_.header.stamp = hand_message_.header.stamp;
  treatment_message_.step = simulation.steps() - 1;
  treatment_message_.time = simulation.time();
  toMessage(simulation, treatment_message_);
  treatment_.publish(treatment_message_);
}

void RodPublisher::publishTip(const simulation::Simulation& simulation)
{
  const std::vector<Eigen::Vector3d>& x = simulation.state().position;
  const std::size_t n = x.size();
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), (x[n - 1] - x[n - 2]).normalized());
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = hand_message_.header.stamp;
  transform.header.frame_id = names::kPatientFrame;
  transform.child_frame_id = names::kTipFrame;
  transform.transform.translation = toVector(x[n - 1]);
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  transforms_.sendTransform(transform);
}

void RodPublisher::publishOperatingState(const std::string& state, const std::string& reason)
{
  if (state == operating_state_)
    return;
  operating_state_ = state;
  OperatingState message;
  message.header.stamp = ros::Time::now();
  message.state = state;
  message.reason = reason;
  message.is_busy = state == "ENABLED";
  for (ros::Publisher& instrument : operating_)
    instrument.publish(message);
}

}  // namespace endovascular_sim::nodes
