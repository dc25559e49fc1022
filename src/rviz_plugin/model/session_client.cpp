#include "rviz_plugin/model/session_client.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <sensor_msgs/JointState.h>
#include <std_srvs/Trigger.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/GoToStep.h"
#include "nodes/conversions/operating_state_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "rviz_plugin/model/centreline_tree.h"
#include "rviz_plugin/model/message_points.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

namespace names = nodes::names;

constexpr double kBranchPeriod = 0.2;         ///< time between two searches of the branch [s]
constexpr double kDiagnosisAge = 3.0;         ///< age after which a diagnosis is not shown [s]
constexpr double kSearchPeriod = 1.0;         ///< time between two searches of instruments without a session node [s]
constexpr double kSameRun = 0.5;              ///< difference of the times of two messages of one run [s]
constexpr double kUnknownSpeed = 0.05;        ///< speed of an instrument whose scene is unknown [m/s]
constexpr double kUnknownTurningSpeed = 6.0;  ///< [rad/s]

const char* serviceOf(Request request)
{
  switch (request)
  {
    case Request::kPause:
      return names::kSimulationPause;
    case Request::kReset:
      return names::kSimulationReset;
    case Request::kStopRecording:
      return names::kSessionStop;
    case Request::kRepeatStep:
      return names::kGoToStep;
    case Request::kStart:
      break;
  }
  return names::kSimulationResume;
}

/** Calls a service with a response of success and message. */
template <typename Service>
CallOutcome outcomeOf(const std::string& name, Service service)
{
  if (!ros::service::exists(name, false))
    return {false, name + " is not available"};
  if (!ros::service::call(name, service))
    return {false, name + " does not respond"};
  return {static_cast<bool>(service.response.success), service.response.message};
}

double secondsSince(std::chrono::steady_clock::time_point time)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - time).count();
}

sensor_msgs::JointState jointState()
{
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time::now();
  message.name = {names::kInsertionJoint, names::kRotationJoint};
  return message;
}

}  // namespace

SessionClient::SessionClient(const ros::NodeHandle& node) : node_(node), spinner_(1, &queue_)
{
  node_.setCallbackQueue(&queue_);
  subscribe();
  commander_ = std::make_unique<VelocityCommander>([this](const HandVelocity& velocity) { send(velocity); });
  spinner_.start();
}

SessionClient::~SessionClient()
{
  commander_.reset();  // sends a last zero
  spinner_.stop();
}

void SessionClient::subscribe()
{
  c_arm_ = node_.advertise<CArm>(names::kCArmCommand, 4);
  subscribers_.push_back(nodes::subscribeGuarded<SessionInfo>(
      node_, names::kSessionInfo, 1, [this](const SessionInfoConstPtr& info) { receiveScene(info); }));
  subscribers_.push_back(nodes::subscribeGuarded<RodStateVisual>(
      node_, names::kRodStateVisual, 1, [this](const RodStateVisualConstPtr& message) { receiveWire(message); }));
  subscribers_.push_back(nodes::subscribeGuarded<VesselCentreline>(node_, names::kVesselCentreline, 1,
                                                                   [this](const VesselCentrelineConstPtr& message)
                                                                   {
                                                                     const vessel::BranchFinder branches(
                                                                         centrelineTree(*message));
                                                                     const std::lock_guard<std::mutex> lock(mutex_);
                                                                     branches_ = branches;
                                                                   }));
  subscribers_.push_back(nodes::subscribeGuarded<ProcedureStep>(
      node_, names::kProcedureStep, 4, [this](const ProcedureStepConstPtr& message) { receiveStep(message); }));
  subscribers_.push_back(nodes::subscribeGuarded<SessionSample>(
      node_, names::kSessionSample, 4, [this](const SessionSampleConstPtr& message) { receiveSample(message); }));
  subscribers_.push_back(nodes::subscribeGuarded<CArm>(node_, names::kCArmCommand, 4,
                                                       [this](const CArmConstPtr& message)
                                                       {
                                                         const std::lock_guard<std::mutex> lock(mutex_);
                                                         state_.c_arm_view = message->view;
                                                       }));
  subscribers_.push_back(nodes::subscribeGuarded<diagnostic_msgs::DiagnosticArray>(
      node_, names::kDiagnostics, 10,
      [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { receiveDiagnostics(message); }));
  subscribers_.push_back(nodes::subscribeGuarded<SessionProgress>(
      node_, names::kSessionProgress, 1, [this](const SessionProgressConstPtr& message) { receiveProgress(message); }));
  search_ = node_.createWallTimer(ros::WallDuration(kSearchPeriod),
                                  [this](const ros::WallTimerEvent& /*event*/) { searchInstruments(); });
}

SessionState SessionClient::state() const
{
  SessionState state;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state = state_;
    state.wire_age = state.has_wire ? secondsSince(wire_received_) : 0.0;
    state.error_age = state.last_error.empty() ? 1e9 : secondsSince(error_noted_);
    for (const auto& [name, topics] : instruments_)
      if (topics->state)
      {
        state.operating[name] = *topics->state;
        state.operating[name].reason = topics->reason;
      }
    for (const auto& [name, diagnosis] : diagnoses_)
      if (secondsSince(diagnosis.received) < kDiagnosisAge)
        (diagnosis.is_error ? state.errors : state.warnings).push_back(diagnosis.text);
  }
  state.dead_man_stops = commander_->timeOuts();
  state.answer = calls_.answer();
  state.waiting = calls_.waiting();
  const std::lock_guard<std::mutex> lock(recording_->mutex);
  state.run = recording_->run;
  state.is_recording = recording_->run > 0 && recording_->run != recording_->stopped_run;
  return state;
}

void SessionClient::receiveScene(const SessionInfoConstPtr& info)
{
  SceneSummary scene;
  try
  {
    scene = sceneSummary(*info);
  }
  catch (const std::exception& error)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    diagnoses_["scene"] = {std::string("scene: ") + error.what(), true, Clock::now()};
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(recording_->mutex);
    recording_->run = std::max(recording_->run, 1U);
  }
  connectInstruments(scene);
}

void SessionClient::connectInstruments(const SceneSummary& scene)
{
  std::map<std::string, std::shared_ptr<Topics>> instruments;
  for (const InstrumentSummary& instrument : scene.instruments)
  {
    const std::string& name = instrument.shape.name;
    const std::string prefix = names::kInstruments + name;
    auto topics = std::make_shared<Topics>();
    if (instrument.takes_commands)
    {
      topics->servo_jv = node_.advertise<sensor_msgs::JointState>(prefix + names::kServoJv, 2);
      topics->servo_jr = node_.advertise<sensor_msgs::JointState>(prefix + names::kServoJr, 4);
    }
    Topics* target = topics.get();  // its subscribers end before it
    topics->operating_state = nodes::subscribeGuarded<crtk_msgs::OperatingState>(
        node_, prefix + names::kOperatingState, 2,
        [this, target](const crtk_msgs::OperatingStateConstPtr& message)
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          nodes::fromMessage(*message, target->state.emplace());
        });
    topics->state_reason = nodes::subscribeGuarded<crtk_msgs::StringStamped>(
        node_, prefix + names::kStateReason, 2,
        [this, target](const crtk_msgs::StringStampedConstPtr& message)
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          target->reason = message->string;
        });
    instruments[name] = topics;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.scene = scene;
  instruments_.swap(instruments);  // the earlier ones end after the lock
}

void SessionClient::searchInstruments()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!instruments_.empty())
      return;
  }
  ros::master::V_TopicInfo topics;
  if (!ros::master::getTopics(topics))
    return;
  const std::string prefix = node_.resolveName(names::kInstruments);
  const std::string suffix = names::kMeasuredJs;
  std::set<std::string> found;
  for (const ros::master::TopicInfo& topic : topics)
    if (topic.name.size() > prefix.size() + suffix.size() && topic.name.rfind(prefix, 0) == 0 &&
        topic.name.compare(topic.name.size() - suffix.size(), suffix.size(), suffix) == 0)
      found.insert(topic.name.substr(prefix.size(), topic.name.size() - prefix.size() - suffix.size()));
  SceneSummary scene;
  for (const std::string& name : found)
  {
    InstrumentSummary instrument;
    instrument.shape.name = name;
    instrument.largest_speed = kUnknownSpeed;
    instrument.largest_turning_speed = kUnknownTurningSpeed;
    instrument.takes_commands = true;
    scene.instruments.push_back(instrument);
  }
  // With several instruments only the scene tells their order in the state.
  if (scene.instruments.size() == 1)
    connectInstruments(scene);
}

void SessionClient::receiveWire(const RodStateVisualConstPtr& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!message->nodes.empty() && (state_.branch.empty() || secondsSince(branch_found_) > kBranchPeriod))
  {
    state_.branch = branches_.nameAt(toEigen(message->nodes.back()));
    branch_found_ = Clock::now();
  }
  if (message->time < state_.wire.time)
    beginRun(message->time);
  noteForces(message->hand_force);
  state_.wire = *message;
  state_.wire.nodes.clear();
  state_.wire.radius.clear();
  state_.wire.contact_force.clear();
  state_.has_wire = true;
  wire_received_ = Clock::now();
}

/** Forgets what was of the run before. @param time simulated time of the new one [s] */
void SessionClient::beginRun(double time)
{
  state_.peak_force.clear();
  state_.last_error.clear();
  if (state_.step.time > time + kSameRun)
  {
    state_.has_step = false;
    state_.step = ProcedureStep();
  }
}

void SessionClient::receiveSample(const SessionSampleConstPtr& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (std::abs(message->time - state_.wire.time) < kSameRun)
    noteForces(message->peak_hand_force);
}

void SessionClient::receiveStep(const ProcedureStepConstPtr& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.step = *message;
  state_.has_step = true;
  noteError(errors_.follow(*message, state_.branch));
}

void SessionClient::receiveProgress(const SessionProgressConstPtr& message)
{
  {
    const std::lock_guard<std::mutex> lock(recording_->mutex);
    recording_->run = message->run;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  noteError(errors_.follow(*message));
}

/** Follows the largest forces. Requires the lock. */
void SessionClient::noteForces(const std::vector<double>& forces)
{
  state_.peak_force.resize(std::max(state_.peak_force.size(), forces.size()), 0.0);
  for (std::size_t k = 0; k < forces.size(); ++k)
    if (std::abs(forces[k]) > state_.peak_force[k])
      state_.peak_force[k] = std::abs(forces[k]);
}

/** Takes over a new error, if any. Requires the lock. */
void SessionClient::noteError(const std::string& error)
{
  if (error.empty())
    return;
  state_.last_error = error;
  error_noted_ = Clock::now();
}

void SessionClient::receiveDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const diagnostic_msgs::DiagnosticStatus& status : message->status)
  {
    if (status.level == diagnostic_msgs::DiagnosticStatus::OK)
      diagnoses_.erase(status.name);
    else
      diagnoses_[status.name] = {status.name + ": " + status.message,
                                 status.level != diagnostic_msgs::DiagnosticStatus::WARN, Clock::now()};
  }
}

void SessionClient::send(const HandVelocity& velocity)
{
  sensor_msgs::JointState command = jointState();
  command.velocity = {velocity.insertion, velocity.rotation};
  publish(velocity.instrument, false, command);
}

void SessionClient::changePressure(const std::string& instrument, double difference)
{
  if (!std::isfinite(difference))
    return;
  sensor_msgs::JointState command = jointState();
  command.name.emplace_back(names::kPressureJoint);
  command.position = {0.0, 0.0, difference};
  publish(instrument, true, command);
}

void SessionClient::publish(const std::string& instrument, bool is_relative, const sensor_msgs::JointState& command)
{
  std::shared_ptr<Topics> topics;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = instruments_.find(instrument);
    if (found == instruments_.end())
      return;
    topics = found->second;
  }
  const ros::Publisher& publisher = is_relative ? topics->servo_jr : topics->servo_jv;
  if (publisher)
    publisher.publish(command);
}

void SessionClient::moveCArm(const std::string& view)
{
  CArm command;
  command.header.stamp = ros::Time::now();
  command.view = view;
  c_arm_.publish(command);
}

void SessionClient::request(Request request)
{
  const std::string service = node_.resolveName(serviceOf(request));
  const auto call = [recording = recording_, service, request]() -> CallOutcome
  {
    if (request == Request::kRepeatStep)
      return outcomeOf(service, GoToStep());
    const CallOutcome outcome = outcomeOf(service, std_srvs::Trigger());
    if (outcome.is_success && request == Request::kStopRecording)
    {
      const std::lock_guard<std::mutex> lock(recording->mutex);
      recording->stopped_run = recording->run;
    }
    return outcome;
  };
  calls_.begin(request, serviceOf(request), call);
}

}  // namespace endovascular_sim::rviz_plugin
