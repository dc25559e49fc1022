#include "nodes/robot/robot_node.h"

#include <algorithm>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/Empty.h>
#include <std_msgs/String.h>

#include "common/error.h"
#include "nodes/conversions/command_diagnostics.h"
#include "nodes/conversions/command_topics.h"
#include "nodes/conversions/operating_state_conversions.h"
#include "nodes/conversions/robot_conversions.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kDiagnosticsPeriod = 1.0;       // s
constexpr double kJointStatesPeriod = 1.0 / 60;  // s, of the drawn robot
constexpr int kQueue = 100;                      // steps

const std::string kName = names::kRobot;

/** Refuses a URDF whose frames would move those of the simulation. */
void checkFrames(const robot::RobotModel& model)
{
  for (const std::string& link : model.links)
    for (const char* frame : {names::kPatientFrame, names::kIntroducerFrame, names::kTipFrame, names::kXRaySourceFrame})
      if (link == frame)
        throw InputError(model.file, "link '" + link + "'",
                         "is the name of a frame of the simulation; rename the link");
}

}  // namespace

RobotNode::RobotNode(const ros::NodeHandle& node, const scene::Scene& scene)
  : node_(node), control_(robotControl(scene))
{
  checkFrames(control_.model());
  node_.setParam(names::kRobotDescription, control_.model().urdf);
  description_ = node_.advertise<std_msgs::String>(names::kRobotDescriptionTopic, 1, true);
  std_msgs::String description;
  description.data = control_.model().urdf;
  description_.publish(description);
  frames_.sendTransform(toTransform(*scene.robot));
  advertise();
  connectInstruments();
  connectClients();
  sensor_msgs::JointState start;
  start.header.stamp = ros::Time::now();
  for (std::size_t k = 0; k < control_.links().size(); ++k)
    start.position.push_back(control_.position(
        k,
        control_.instruments()[control_.instrumentOf(k)].start[static_cast<std::size_t>(control_.links()[k].motion)]));
  publishAllJoints(start);
  publishState();
  updater_.setHardwareID(control_.model().name);
  updater_.add("Robot", this, &RobotNode::diagnose);
  diagnostics_timer_ = node_.createSteadyTimer(ros::WallDuration(kDiagnosticsPeriod),
                                               [this](const ros::SteadyTimerEvent&) { publishDiagnostics(updater_); });
}

void RobotNode::advertise()
{
  const ros::SubscriberStatusCallback update = [this](const ros::SingleSubscriberPublisher&) { updateSubscriptions(); };
  const auto joints = [&](JointStream& stream, const char* topic)
  {
    stream.topic = topic;
    stream.publisher = node_.advertise<sensor_msgs::JointState>(kName + topic, kQueue, update, update);
    stream.newest.resize(control_.instruments().size());
  };
  joints(measured_, names::kMeasuredJs);
  joints(setpoint_, names::kSetpointJs);
  joints(goal_, names::kGoalJs);
  joint_states_ =
      node_.advertise<sensor_msgs::JointState>(names::kRobotJointStates, 1, update, update, ros::VoidConstPtr(), true);
  tip_ = node_.advertise<geometry_msgs::PoseStamped>(kName + names::kMeasuredCp, kQueue, update, update);
  wall_force_ = node_.advertise<geometry_msgs::WrenchStamped>(kName + names::kMeasuredCf, kQueue, update, update);
  state_ = node_.advertise<crtk_msgs::OperatingState>(kName + names::kOperatingState, 10, true);
  reason_ = node_.advertise<crtk_msgs::StringStamped>(kName + names::kStateReason, 10, true);
}

void RobotNode::connectInstruments()
{
  for (std::size_t k = 0; k < control_.instruments().size(); ++k)
  {
    Instrument instrument;
    instrument.name = names::kInstruments + control_.instruments()[k].name;
    for (const CommandTopic& topic : kCommandTopics)
      instrument.commands[topic.kind] = node_.advertise<sensor_msgs::JointState>(instrument.name + topic.name, 10);
    for (const WordTopic& topic : kWordTopics)
      instrument.words[topic.word] = node_.advertise<std_msgs::Empty>(instrument.name + topic.name, 10);
    instrument.state_command = node_.advertise<crtk_msgs::StringStamped>(instrument.name + names::kStateCommand, 10);
    instruments_.push_back(instrument);
  }
  for (std::size_t k = 0; k < instruments_.size(); ++k)
  {
    const std::string& name = instruments_[k].name;
    subscribers_.push_back(subscribeGuarded<crtk_msgs::StringStamped>(node_, name + names::kStateReason, 10,
                                                                      [this, k](const crtk_msgs::StringStamped& reason)
                                                                      { receiveReason(k, reason.string); }));
    subscribers_.push_back(subscribeGuarded<crtk_msgs::OperatingState>(node_, name + names::kOperatingState, 10,
                                                                       [this, k](const crtk_msgs::OperatingState& state)
                                                                       { receiveState(k, state); }));
  }
  updateSubscriptions();
}

void RobotNode::connectClients()
{
  for (const CommandTopic& topic : kCommandTopics)
    subscribers_.insert(subscribers_.begin(),
                        subscribeToCommands<sensor_msgs::JointState>(
                            node_, kName + topic.name, nullptr,
                            [this, kind = topic.kind](const ros::MessageEvent<sensor_msgs::JointState const>& event)
                            { receive(kind, event); }));
  for (const WordTopic& topic : kWordTopics)
    subscribers_.insert(subscribers_.begin(),
                        subscribeToCommands<std_msgs::Empty>(node_, kName + topic.name, nullptr,
                                                             [this, word = topic.word](const auto& event)
                                                             { receiveWord(event.getPublisherName(), word); }));
  clients_ = std::size(kCommandTopics) + std::size(kWordTopics);
  subscribers_.push_back(subscribeToCommands<crtk_msgs::StringStamped>(
      node_, kName + names::kStateCommand, nullptr,
      [this](const ros::MessageEvent<crtk_msgs::StringStamped const>& event)
      { receiveWord(event.getPublisherName(), event.getConstMessage()->string); }));
}

void RobotNode::subscribe(JointStream& stream, bool wanted)
{
  if (wanted == !stream.subscribers.empty())
    return;
  stream.subscribers.clear();
  for (std::size_t k = 0; wanted && k < instruments_.size(); ++k)
    stream.subscribers.push_back(subscribeGuarded<sensor_msgs::JointState>(
        node_, instruments_[k].name + stream.topic, kQueue,
        [this, &stream, k](const sensor_msgs::JointState& joints) { receiveJoints(stream, k, joints); }));
}

/** Passes a topic of the first instrument on, while it has a subscriber. */
template <typename Message>
void RobotNode::relay(const char* topic, const ros::Publisher& publisher, ros::Subscriber& subscriber)
{
  const bool wanted = publisher.getNumSubscribers() > 0;
  if (wanted == static_cast<bool>(subscriber))
    return;
  subscriber.shutdown();
  if (!wanted)
    return;
  const std::string& name = instruments_[control_.instrumentOf(0)].name;
  subscriber = subscribeGuarded<Message>(node_, name + topic, kQueue,
                                         [publisher](const boost::shared_ptr<Message const>& message)
                                         { publisher.publish(message); });
}

void RobotNode::updateSubscriptions()
{
  subscribe(setpoint_, true);  // the control follows it
  subscribe(measured_, measured_.publisher.getNumSubscribers() + joint_states_.getNumSubscribers() > 0);
  subscribe(goal_, goal_.publisher.getNumSubscribers() > 0);
  relay<geometry_msgs::PoseStamped>(names::kMeasuredCp, tip_, tip_subscriber_);
  relay<geometry_msgs::WrenchStamped>(names::kMeasuredCf, wall_force_, wall_force_subscriber_);
}

/** True if all instruments of a command read it. */
bool RobotNode::isHeard(const robot::RobotAnswer& answer) const
{
  return std::all_of(answer.commands.begin(), answer.commands.end(),
                     [this](const robot::InstrumentCommand& command)
                     {
                       const Instrument& instrument = instruments_[command.instrument];
                       return instrument.commands.at(command.joints.kind).getNumSubscribers() > 0;
                     });
}

void RobotNode::receive(drive::CommandKind kind, const ros::MessageEvent<sensor_msgs::JointState const>& event)
{
  const sensor_msgs::JointState& message = *event.getConstMessage();
  const robot::RobotAnswer answer =
      control_.command(event.getPublisherName(), kind, message.name, valuesOf(message, kind), time_);
  if (answer.verdict != drive::CommandVerdict::kAccepted)
    ROS_WARN_THROTTLE(5.0, "rejected a %s", answer.reason.c_str());
  else if (!isHeard(answer))
    ROS_WARN_THROTTLE(5.0, "rod_dynamics does not read the commands; wait for robot/operating_state ENABLED");
  for (const robot::InstrumentCommand& command : answer.commands)
    give(command);
  if (kind == drive::CommandKind::kMovePosition || kind == drive::CommandKind::kMoveRelative)
    publishState();  // a client waits for the beginning and the end of its move
}

void RobotNode::give(const robot::InstrumentCommand& command)
{
  sensor_msgs::JointState message = toMessage(command.joints);
  message.header.stamp = ros::Time::now();
  instruments_[command.instrument].commands.at(command.joints.kind).publish(message);
}

/** Passes a command without values on to all instruments. */
void RobotNode::receiveWord(const std::string& client, const std::string& word)
{
  const std::string refusal = control_.stateCommand(client, word, time_);
  if (!refusal.empty())
  {
    ROS_WARN_THROTTLE(5.0, "rejected a %s", refusal.c_str());
    publishState();
    return;
  }
  const crtk_msgs::StringStamped message = reasonMessage(word, ros::Time::now());
  for (const Instrument& instrument : instruments_)
    if (const auto topic = instrument.words.find(word); topic != instrument.words.end())
      topic->second.publish(std_msgs::Empty());
    else
      instrument.state_command.publish(message);
}

void RobotNode::receiveState(std::size_t instrument, const crtk_msgs::OperatingState& state)
{
  Instrument& target = instruments_[instrument];
  fromMessage(state, target.state);
  target.has_state = true;
  control_.setState(instrument, target.state);
  publishState();
}

/** Takes over a reason, which may arrive before or after its state. */
void RobotNode::receiveReason(std::size_t instrument, const std::string& reason)
{
  instruments_[instrument].state.reason = reason;
  if (!instruments_[instrument].has_state)
    return;
  control_.setReason(instrument, reason);
  publishReason();
}

void RobotNode::publishReason()
{
  const std::string reason = control_.state().reason;
  if (reason == published_reason_)
    return;
  reason_.publish(reasonMessage(reason, ros::Time::now()));
  published_reason_ = reason;
}

/** Publishes the state of the robot; the reason precedes it. */
void RobotNode::publishState()
{
  publishReason();
  state_.publish(toMessage(control_.state(), ros::Time::now()));
}

void RobotNode::follow(std::size_t instrument, const sensor_msgs::JointState& setpoint)
{
  time_ = setpoint.header.stamp.toSec();
  if (const auto command = control_.follow(instrument, motionsOf(setpoint, setpoint.position), time_))
    give(*command);
}

/** Publishes the joints of a step when those of all instruments have arrived. */
void RobotNode::receiveJoints(JointStream& stream, std::size_t instrument, const sensor_msgs::JointState& joints)
{
  if (&stream == &setpoint_)
    follow(instrument, joints);
  stream.newest[instrument] = joints;
  for (const sensor_msgs::JointState& other : stream.newest)
    if (other.header.stamp != joints.header.stamp)
      return;
  sensor_msgs::JointState message;
  toMessage(control_, stream.newest, message);
  if (stream.publisher.getNumSubscribers() > 0)
    stream.publisher.publish(message);
  if (&stream == &measured_)
    publishAllJoints(message);
}

void RobotNode::publishAllJoints(const sensor_msgs::JointState& linked)
{
  const double since = linked.header.stamp.toSec() - joint_states_at_.toSec();  // any two times have a difference
  if (since >= 0.0 && since < kJointStatesPeriod && !joint_states_at_.isZero())
    return;
  joint_states_at_ = linked.header.stamp;
  sensor_msgs::JointState all;
  toAllJoints(control_, linked, all);
  joint_states_.publish(all);
}

void RobotNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  using diagnostic_msgs::DiagnosticStatus;
  const drive::ControlState state = control_.state();
  status.summary(state.state == drive::OperatingState::kEnabled ? DiagnosticStatus::OK : DiagnosticStatus::WARN,
                 drive::nameOf(state.state) + (state.reason.empty() ? "" : ": " + state.reason));
  CommandReport report;
  report.instrument = node_.resolveName(kName);
  report.has_publisher = std::any_of(subscribers_.begin(), subscribers_.begin() + static_cast<std::ptrdiff_t>(clients_),
                                     [](const ros::Subscriber& commands) { return commands.getNumPublishers() > 0; });
  fill(report, control_.arbiter());
  diagnoseCommands(report, status);
  IgnoredMessages::ofProcess().diagnose(status);
}

}  // namespace endovascular_sim::nodes
