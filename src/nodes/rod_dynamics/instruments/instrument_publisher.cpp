#include "nodes/rod_dynamics/instruments/instrument_publisher.h"

#include <algorithm>

#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/joint_state_conversions.h"
#include "nodes/conversions/operating_state_conversions.h"
#include "nodes/rod_dynamics/instruments/instrument_observation.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/instrument_tip.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kJointQueue = 1;   ///< readers use the newest values only
constexpr int kStateQueue = 10;  ///< a move may end soon after its begin

}  // namespace

InstrumentPublisher::InstrumentPublisher(ros::NodeHandle& node, const scene::Scene& scene, DriveCommands& commands)
  : time_step_(scene.solver.time_step), commands_(commands), channels_(scene.instruments.size())
{
  for (std::size_t k = 0; k < channels_.size(); ++k)
  {
    const instrument::Instrument& instrument = scene.instruments[k].instrument;
    const std::string name = names::kInstruments + instrument.name;
    Channel& channel = channels_[k];
    channel.measured = node.advertise<sensor_msgs::JointState>(name + names::kMeasuredJs, kJointQueue);
    channel.setpoint = node.advertise<sensor_msgs::JointState>(name + names::kSetpointJs, kJointQueue);
    channel.goal = node.advertise<sensor_msgs::JointState>(name + names::kGoalJs, kJointQueue);
    channel.tip = node.advertise<geometry_msgs::PoseStamped>(name + names::kMeasuredCp, kJointQueue);
    channel.wall_force = node.advertise<geometry_msgs::WrenchStamped>(name + names::kMeasuredCf, kJointQueue);
    channel.state = node.advertise<crtk_msgs::OperatingState>(name + names::kOperatingState, kStateQueue, true);
    channel.reason = node.advertise<crtk_msgs::StringStamped>(name + names::kStateReason, kStateQueue, true);
    channel.has_balloon = instrument.balloon.has_value();
  }
  joints_.header.frame_id = names::kIntroducerFrame;
}

void InstrumentPublisher::publishStep(const simulation::Simulation& simulation, const std::vector<RenderedHand>& hands,
                                      ros::Time now)
{
  now_ = now;
  bool has_contacts = false;
  for (std::size_t k = 0; k < channels_.size(); ++k)
  {
    Channel& channel = channels_[k];
    const simulation::HandState hand = simulation.hand(static_cast<int>(k));
    channel.last = has_last_ ? channel.now : hand;
    channel.now = hand;
    if (!has_last_)
      channel.last_command = hands[k].command;
    if (channel.measured.getNumSubscribers() > 0)
      publishMeasured(simulation, k);
    if (channel.setpoint.getNumSubscribers() > 0)
      publishSetpoint(k, hands[k], 1.0, true);
    if (channel.tip.getNumSubscribers() > 0)
      publishTip(k, simulation);
    if (channel.wall_force.getNumSubscribers() > 0)
    {
      if (!has_contacts)
        simulation::wallContacts(simulation, contacts_);
      has_contacts = true;
      publishWallForce(k, simulation);
    }
    channel.last_command = hands[k].command;
  }
  has_last_ = true;
  publishGoals(hands);
  publishStates();
}

void InstrumentPublisher::publishPaused(const std::vector<RenderedHand>& hands, double share, ros::Time now)
{
  now_ = now;
  for (std::size_t k = 0; k < channels_.size(); ++k)
    if (channels_[k].setpoint.getNumSubscribers() > 0)
      publishSetpoint(k, hands[k], share, false);
  publishStates();
}

void InstrumentPublisher::measure(const simulation::Simulation& simulation, std::size_t instrument,
                                  sensor_msgs::JointState& joints) const
{
  const Channel& channel = channels_[instrument];
  const simulation::HandState hand = simulation.hand(static_cast<int>(instrument));
  const simulation::HandState last = has_last_ ? channel.last : hand;
  setJoints(channel.has_balloon, {hand.insertion, hand.rotation, hand.pressure}, joints.position, joints.name);
  joints.velocity = {(hand.insertion - last.insertion) / time_step_, (hand.rotation - last.rotation) / time_step_};
  joints.effort = {hand.force, hand.torque};
  if (!channel.has_balloon)
    return;
  joints.velocity.push_back((hand.pressure - last.pressure) / time_step_);
  joints.effort.push_back(0.0);
}

void InstrumentPublisher::reset()
{
  has_last_ = false;
  for (Channel& channel : channels_)
    channel.published_state.reset();
  revision_ = ~std::uint64_t{0};
}

void InstrumentPublisher::publishMeasured(const simulation::Simulation& simulation, std::size_t k)
{
  measure(simulation, k, joints_);
  joints_.header.stamp = now_;
  channels_[k].measured.publish(joints_);
}

void InstrumentPublisher::publishSetpoint(std::size_t k, const RenderedHand& hand, double share, bool moves)
{
  const Channel& channel = channels_[k];
  const drive::HandCommand& command = hand.command;
  const double rate = moves ? 1.0 / time_step_ : 0.0;
  joints_.header.stamp = now_;
  setJoints(channel.has_balloon, {command.insertion, command.rotation, command.pressure}, joints_.position,
            joints_.name);
  joints_.velocity = {rate * (command.insertion - channel.last_command.insertion),
                      rate * (command.rotation - channel.last_command.rotation)};
  joints_.effort = {share * hand.force, share * hand.torque};
  if (channel.has_balloon)
  {
    joints_.velocity.push_back(rate * (command.pressure - channel.last_command.pressure));
    joints_.effort.push_back(0.0);
  }
  channel.setpoint.publish(joints_);
}

void InstrumentPublisher::publishGoals(const std::vector<RenderedHand>& hands)
{
  if (std::none_of(channels_.begin(), channels_.end(),
                   [](const Channel& channel) { return channel.goal.getNumSubscribers() > 0; }))
    return;
  used_.clear();
  for (const RenderedHand& hand : hands)
    used_.push_back(hand.command);
  commands_.goals(used_, goals_);
  joints_.header.stamp = now_;
  joints_.velocity.clear();
  joints_.effort.clear();
  for (std::size_t k = 0; k < channels_.size(); ++k)
  {
    setJoints(channels_[k].has_balloon, {goals_[k].insertion, goals_[k].rotation, goals_[k].pressure}, joints_.position,
              joints_.name);
    if (channels_[k].goal.getNumSubscribers() > 0)
      channels_[k].goal.publish(joints_);
  }
}

/** An instrument outside the introducer has no valid tip: stamp 0. */
void InstrumentPublisher::publishTip(std::size_t k, const simulation::Simulation& simulation)
{
  pose_.header.stamp = simulation.hand(static_cast<int>(k)).insertion >= 0.0 ? now_ : ros::Time();
  pose_.header.frame_id = names::kPatientFrame;
  pose_.pose = tipPose(simulation, k);
  channels_[k].tip.publish(pose_);
}

/** Sum of the wall's forces on an instrument, and their moment about its tip. */
void InstrumentPublisher::publishWallForce(std::size_t k, const simulation::Simulation& simulation)
{
  const double inserted = simulation.hand(static_cast<int>(k)).insertion;
  const Eigen::Vector3d tip = simulation::pointAt(simulation, std::max(0.0, inserted));
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const simulation::WallContact& contact : contacts_)
  {
    if (!isOn(simulation, k, contact))
      continue;
    const Eigen::Vector3d sum = contact.normal_force + contact.friction_force;
    force += sum;
    moment += (contact.position - tip).cross(sum);
  }
  wrench_.header.stamp = now_;
  wrench_.header.frame_id = names::kPatientFrame;
  wrench_.wrench.force = toVector(force);
  wrench_.wrench.torque = toVector(moment);
  channels_[k].wall_force.publish(wrench_);
}

void InstrumentPublisher::setSimulationState(drive::OperatingState state, const std::string& reason, ros::Time now)
{
  simulation_state_ = state;
  simulation_reason_ = reason;
  revision_ = ~std::uint64_t{0};
  now_ = now;
  publishStates();
}

/** Publishes the states that have changed, or that answer a command; the reason precedes its state. */
void InstrumentPublisher::publishStates()
{
  const std::uint64_t revision = commands_.revision();
  if (revision == revision_)
    return;
  revision_ = revision;
  std::vector<drive::ControlState> states = commands_.states();
  for (std::size_t k = 0; k < channels_.size(); ++k)
  {
    drive::ControlState& state = states[k];
    if (simulation_state_ != drive::OperatingState::kEnabled)
    {
      state.state = simulation_state_;
      state.reason = simulation_reason_;
    }
    Channel& channel = channels_[k];
    if (state.revision == channel.revision && state.state == channel.published_state &&
        state.reason == channel.published_reason)
      continue;
    if (state.reason != channel.published_reason || !channel.published_state)
      channel.reason.publish(reasonMessage(state.reason, now_));
    channel.state.publish(toMessage(state, now_));
    channel.revision = state.revision;
    channel.published_state = state.state;
    channel.published_reason = state.reason;
  }
}

}  // namespace endovascular_sim::nodes
