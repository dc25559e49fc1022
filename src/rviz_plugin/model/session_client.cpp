#include "rviz_plugin/model/session_client.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <sensor_msgs/JointState.h>
#include <std_srvs/Trigger.h>

#include "common/error.h"
#include "endovascular_sim/AlignExpert.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/GoToStep.h"
#include "endovascular_sim/InjectContrast.h"
#include "endovascular_sim/SetHemodynamics.h"
#include "endovascular_sim/SetMotion.h"
#include "endovascular_sim/SetSubject.h"
#include "nodes/conversions/operating_state_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "rviz_plugin/model/centreline_tree.h"
#include "rviz_plugin/model/diagnosis_text.h"
#include "rviz_plugin/model/message_points.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

namespace names = nodes::names;

constexpr std::uint32_t kPressureQueue = 100;  ///< readings of a fraction of a second
constexpr double kBranchPeriod = 0.2;          ///< time between two searches of the branch [s]
constexpr double kLeastErrorTime = 2.0;        ///< during which an error is announced, also if it is over [s]
constexpr double kDiagnosisAge = 3.0;          ///< age after which a diagnosis is not shown [s]
constexpr double kSearchPeriod = 1.0;          ///< time between two searches of instruments without a session node [s]
constexpr double kPlayerAge = 5.0;             ///< age after which a player counts as ended [s]
constexpr double kSameRun = 0.5;               ///< difference of the times of two messages of one run [s]
constexpr double kUnknownSpeed = 0.05;         ///< speed of an instrument whose scene is unknown [m/s]
constexpr double kUnknownTurningSpeed = 6.0;   ///< [rad/s]

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
    case Request::kShowExpert:
      return names::kShowExpert;
    case Request::kSetSubject:
      return names::kSetSubject;
    case Request::kSetBlood:
      return names::kSetHemodynamics;
    case Request::kSetMotion:
      return names::kSetMotion;
    case Request::kInject:
      return names::kInjectContrast;
    case Request::kAlignExpert:
      return names::kAlignExpert;
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
  player_ = std::make_unique<PlayerRemote>(
      [service = node_.resolveName(names::kPlayerControl)](const PlayerControl::Request& request)
      {
        PlayerControl call;
        call.request = request;
        const CallOutcome outcome = outcomeOf(service, call);
        return outcome.is_success ? std::string() : outcome.text;
      });
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
  subscribers_.push_back(nodes::subscribeGuarded<SessionVerdict>(
      node_, names::kSessionVerdict, 1, [this](const SessionVerdictConstPtr& message) { receiveVerdict(*message); }));
  subscribers_.push_back(nodes::subscribeGuarded<PlayerState>(
      node_, names::kPlayerState, 1, [this](const PlayerStateConstPtr& message) { receivePlayer(message); }));
  subscribers_.push_back(nodes::subscribeGuarded<ExpertState>(node_, names::kExpertState, 1,
                                                              [this](const ExpertStateConstPtr& message)
                                                              {
                                                                const std::lock_guard<std::mutex> lock(mutex_);
                                                                state_.expert = *message;
                                                              }));
  subscribers_.push_back(
      nodes::subscribeGuarded<sensor_msgs::FluidPressure>(node_, names::kTipPressure, kPressureQueue,
                                                          [this](const sensor_msgs::FluidPressureConstPtr& message)
                                                          {
                                                            const std::lock_guard<std::mutex> lock(mutex_);
                                                            pressure_.add(*message);
                                                          }));
  subscribers_.push_back(nodes::subscribeGuarded<HeartPhase>(node_, names::kHeartPhase, kPressureQueue,
                                                             [this](const HeartPhaseConstPtr& message)
                                                             {
                                                               const std::lock_guard<std::mutex> lock(mutex_);
                                                               pressure_.add(*message);
                                                             }));
  subscribeToMotion();
  subscribeToContrast();
  search_ = node_.createWallTimer(ros::WallDuration(kSearchPeriod),
                                  [this](const ros::WallTimerEvent& /*event*/) { searchInstruments(); });
}

void SessionClient::subscribeToMotion()
{
  subscribers_.push_back(nodes::subscribeGuarded<MotionState>(node_, names::kMotionState, 1,
                                                              [this](const MotionState& message)
                                                              {
                                                                const std::lock_guard<std::mutex> lock(mutex_);
                                                                motion_.add(message);
                                                              }));
  subscribers_.push_back(nodes::subscribeGuarded<MotionControls>(node_, names::kMotionControls, 1,
                                                                 [this](const MotionControls& message)
                                                                 {
                                                                   const std::lock_guard<std::mutex> lock(mutex_);
                                                                   motion_.add(message);
                                                                 }));
}

void SessionClient::subscribeToContrast()
{
  subscribers_.push_back(nodes::subscribeGuarded<ContrastState>(node_, names::kContrastState, 1,
                                                                [this](const ContrastState& message)
                                                                {
                                                                  const std::lock_guard<std::mutex> lock(mutex_);
                                                                  contrast_.add(message);
                                                                }));
}

SessionState SessionClient::state() const
{
  SessionState state;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state = state_;
    state.blood = pressure_.state();
    state.motion = motion_.status();
    state.contrast = contrast_.status();
    if (secondsSince(player_received_) > kPlayerAge)
      state.player.reset();
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
  if (!state.player)
    return state;
  takeOverPlayer(state);
  state.answer = player_->answer();
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
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_.subject = info->subject;
    pressure_.setLines(scene.pressure_lines, scene.pressure_frames);
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
  const bool is_jump = std::abs(message->time - state_.wire.time) > kSameRun;
  motion_.countWire();
  contrast_.countWire();
  tip_.reset();
  if (!message->nodes.empty())
    tip_ = motion_.pullBack(toEigen(message->nodes.back()));
  if (is_jump || !tip_ || state_.branch.empty() || secondsSince(branch_found_) > kBranchPeriod)
    findBranch();
  if (errors_.isOver(state_.branch) && secondsSince(error_noted_) > kLeastErrorTime)
    state_.last_error.clear();
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

/** Finds the branch of the foremost tip. Requires the lock. */
void SessionClient::findBranch()
{
  state_.branch = tip_ ? branches_.nameAt(*tip_) : std::string();
  branch_found_ = Clock::now();
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
  findBranch();  // in which the tip is at this event
  noteError(errors_.follow(*message, state_.branch));
}

void SessionClient::receivePlayer(const PlayerStateConstPtr& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.player = *message;
  player_received_ = Clock::now();
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

void SessionClient::receiveVerdict(const SessionVerdict& message)
{
  Verdict verdict{message.run, message.verdict, message.page, message.passed != 0, {}};
  const std::size_t size = message.mark.size();
  if (message.unit.size() != size || message.value.size() != size || message.limit.size() != size ||
      message.expert.size() != size || message.mark_passed.size() != size)
    throw InputError(names::kSessionVerdict, "mark", "the lists must have the same length");
  for (std::size_t k = 0; k < size; ++k)
    verdict.marks.push_back({message.mark[k], message.unit[k], message.value[k], message.limit[k], message.expert[k],
                             message.mark_passed[k] != 0});
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.verdict = verdict;
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
    const std::string text = diagnosisText(status, state_.scene.is_guided);
    if (text.empty())
      diagnoses_.erase(status.name);
    else
      diagnoses_[status.name] = {text, status.level != diagnostic_msgs::DiagnosticStatus::WARN, Clock::now()};
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

void SessionClient::setSubject(const std::string& subject)
{
  SetSubject service;
  service.request.subject = subject;
  const std::string name = node_.resolveName(names::kSetSubject);
  calls_.begin(Request::kSetSubject, names::kSetSubject, [name, service] { return outcomeOf(name, service); });
}

void SessionClient::setBlood(const BloodRequest& request)
{
  SetHemodynamics service;
  service.request.heart_rate = request.heart_rate;
  service.request.mean_pressure = request.mean_pressure;
  service.request.hyperaemia = static_cast<std::int8_t>(request.hyperaemia);
  const std::string name = node_.resolveName(names::kSetHemodynamics);
  calls_.begin(Request::kSetBlood, names::kSetHemodynamics, [name, service] { return outcomeOf(name, service); });
}

void SessionClient::setMotion(const MotionRequest& request)
{
  SetMotion service;
  service.request.heart_rate = request.heart_rate;
  service.request.breathing_rate = request.breathing_rate;
  service.request.breath_hold = static_cast<std::int8_t>(request.breath_hold);
  const std::string name = node_.resolveName(names::kSetMotion);
  calls_.begin(Request::kSetMotion, names::kSetMotion, [name, service] { return outcomeOf(name, service); });
}

void SessionClient::inject(const ContrastRequest& request)
{
  InjectContrast service;
  service.request.volume = request.volume;
  service.request.rate = request.rate;
  service.request.rise = ContrastRequest::kRise;
  service.request.concentration = std::numeric_limits<double>::quiet_NaN();
  service.request.refill = request.refill ? 1 : 0;
  const std::string name = node_.resolveName(names::kInjectContrast);
  calls_.begin(Request::kInject, names::kInjectContrast, [name, service] { return outcomeOf(name, service); });
}

void SessionClient::alignExpert(std::uint8_t alignment)
{
  AlignExpert service;
  service.request.alignment = alignment;
  const std::string name = node_.resolveName(names::kAlignExpert);
  calls_.begin(Request::kAlignExpert, names::kAlignExpert, [name, service] { return outcomeOf(name, service); });
}

}  // namespace endovascular_sim::rviz_plugin
