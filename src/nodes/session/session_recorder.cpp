#include "nodes/session/session_recorder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <type_traits>
#include <utility>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include "common/error.h"
#include "common/text/format.h"
#include "common/version.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "fluoroscopy/image/png_writer.h"
#include "nodes/conversions/joint_state_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

namespace
{

/** Queue length of topics at the step rate: 10 s of messages. */
constexpr std::uint32_t kStepQueue = 10000;
constexpr std::uint32_t kQueue = 1000;
constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]
constexpr double kProgressPeriod = 0.02;    ///< [s]
/** Time from the last step to the end of the recording, and its largest value without the wall forces of that step [s].
 */
constexpr double kSettling = 0.2;
constexpr double kLongestSettling = 3.0;

SessionInfo infoOf(const scene::Scene& scene)
{
  SessionInfo info;
  info.scene_name = scene.name;
  info.scene_yaml = scene.resolved_yaml;
  info.scene_hash = scene.hash();
  info.seed = scene.seed;
  info.time_step = scene.solver.time_step;
  info.software_version = version();
  info.commit = commit();
  info.physics_number = kPhysicsNumber;
  return info;
}

/** Number of steps after which the session ends; the largest number without an end. */
std::uint64_t stepsOf(const scene::Scene& scene, const RecorderSettings& settings)
{
  return settings.stop_at_duration ? static_cast<std::uint64_t>(std::llround(scene.duration / scene.solver.time_step))
                                   : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

SessionRecorder::SessionRecorder(const ros::NodeHandle& node, scene::Scene scene, RecorderSettings settings)
  : node_(node),
    scene_(std::move(scene)),
    settings_(std::move(settings)),
    info_(infoOf(scene_)),
    recording_(
        std::make_unique<Recording>(scene_, createRecordingFolder(settings_.folder), stepsOf(scene_, settings_))),
    last_step_(ros::SteadyTime::now())
{
  info_publisher_ = node_.advertise<SessionInfo>(names::kSessionInfo, 1, true);
  progress_publisher_ = node_.advertise<SessionProgress>(names::kSessionProgress, 1, true);
  if (!scene_.vessel)
    publishInfo();
  listen<SimulationRun>(names::kSimulationRun, kQueue, [this](const auto& event) { onRun(event); });
  subscribeToWire();
  if (scene_.vessel)
    subscribeToVessel();
  if (scene_.fluoroscopy)
    subscribeToFluoroscopy();
  subscribeToGraph();
  stop_ = node_.advertiseService(names::kSessionStop, &SessionRecorder::onStop, this);
  timer_ = node_.createSteadyTimer(ros::WallDuration(0.1), &SessionRecorder::onTimer, this);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("recording",
                   [this](diagnostic_updater::DiagnosticStatusWrapper& status) { fillDiagnostics(status); });
}

SessionRecorder::~SessionRecorder()
{
  finish();
}

template <typename Message>
void SessionRecorder::listen(const std::string& topic, std::uint32_t queue,
                             std::function<void(const ros::MessageEvent<Message const>&)> callback)
{
  subscribers_.push_back(subscribeGuarded<Message>(node_, topic, queue, std::move(callback)));
}

template <typename Message>
void SessionRecorder::record(const std::string& topic, std::uint32_t queue)
{
  const std::string resolved = node_.resolveName(topic);
  listen<Message>(topic, queue,
                  [this, resolved](const ros::MessageEvent<Message const>& event)
                  {
                    if (isRecording())
                      recording_->bag.write(resolved, event);
                  });
}

template <typename Message>
void SessionRecorder::recordLatched(const std::string& topic, std::uint32_t queue)
{
  const std::string resolved = node_.resolveName(topic);
  listen<Message>(topic, queue,
                  [this, resolved](const ros::MessageEvent<Message const>& event)
                  {
                    if (isRecording())
                      recording_->bag.write(resolved, event);
                    latched_[resolved + " " + event.getPublisherName()] = [resolved, event](Recording& recording)
                    { recording.bag.write(resolved, ros::Time::now(), event); };
                  });
}

/** Refuses a message that is further ahead of session/steps than its queue is long, or whose time is not that of its
 * step. */
template <typename Message>
void SessionRecorder::requireKnown(const Message& message, const std::string& topic) const
{
  if (message.step > handled_ + kStepQueue)
    throw InputError(topic, "step", "is " + std::to_string(message.step) + ", far ahead of the simulation");
  if constexpr (std::is_same_v<Message, RodStateVisual> || std::is_same_v<Message, SessionSample> ||
                std::is_same_v<Message, TreatmentVisual>)
  {
    const double dt = scene_.solver.time_step;
    if (!(std::abs(message.time - static_cast<double>(message.step + 1) * dt) < dt))
      throw InputError(topic, "time", "is not that of its step");
  }
}

template <typename Message>
void SessionRecorder::measure(const std::string& topic, std::uint32_t queue)
{
  const std::string resolved = node_.resolveName(topic);
  listen<Message>(topic, queue,
                  [this, resolved](const ros::MessageEvent<Message const>& event)
                  {
                    if (!isRecording())
                      return;
                    requireKnown(*event.getMessage(), resolved);
                    recording_->results.metrics().add(*event.getMessage());  // throws for an invalid one
                    recording_->bag.write(resolved, event);
                  });
}

void SessionRecorder::subscribeToWire()
{
  listen<SessionSteps>(names::kSessionSteps, kStepQueue, [this](const auto& event) { onSteps(event); });
  listen<RodStateVisual>(names::kRodStateVisual, kQueue, [this](const auto& event) { onRod(event); });
  measure<TreatmentVisual>(names::kTreatmentVisual, kQueue);
  for (const scene::DrivenInstrument& driven : scene_.instruments)
  {
    const std::string instrument = names::kInstruments + driven.instrument.name;
    recordLatched<crtk_msgs::OperatingState>(instrument + names::kOperatingState, kQueue);
    recordLatched<crtk_msgs::StringStamped>(instrument + names::kStateReason, kQueue);
  }
}

void SessionRecorder::subscribeToVessel()
{
  listen<VesselMesh>(names::kVesselMesh, 1, [this](const auto& event) { onVessel(event); });
  listen<VesselCentreline>(names::kVesselCentreline, 1, [this](const auto& event) { onCentreline(event); });
  measure<WallDisplacement>(names::kWallDisplacement, kStepQueue);
  if (scene_.procedure)
    measure<ProcedureStep>(names::kProcedureStep, kStepQueue);
  measure<SessionSample>(names::kSessionSample, kStepQueue);
  listen<ContactForces>(names::kContactForces, kQueue, [this](const auto& event) { onContacts(event); });
  listen<ContactForceMap>(names::kContactForceMap, kQueue, [this](const auto& event) { onForceMap(event); });
}

void SessionRecorder::subscribeToFluoroscopy()
{
  listen<sensor_msgs::Image>(names::kFluoroscopyImage, 10, [this](const auto& event) { onImage(event); });
  record<sensor_msgs::CameraInfo>(names::kFluoroscopyCameraInfo, 10);
  record<CArm>(names::kCArmCommand, kQueue);
}

void SessionRecorder::subscribeToGraph()
{
  listen<diagnostic_msgs::DiagnosticArray>(names::kDiagnostics, kQueue,
                                           [this](const auto& event) { onDiagnostics(event); });
  record<tf2_msgs::TFMessage>("/tf", kStepQueue);
  recordLatched<tf2_msgs::TFMessage>("/tf_static", kQueue);
}

void SessionRecorder::publishInfo()
{
  if (info_published_)
    return;
  info_published_ = true;
  info_.header.stamp = ros::Time::now();
  info_publisher_.publish(info_);
  if (isRecording())
    recording_->bag.writeLatched(node_.resolveName(names::kSessionInfo), info_);
}

/** True for steps after the last one, and for the second group of steps after a gap. A stray message has no effect. */
bool SessionRecorder::isNext(const SessionSteps& group)
{
  const std::uint64_t step = group.steps.front().step;
  const bool is_next = step == handled_ || step == after_gap_;
  after_gap_ = step + group.steps.size();
  return is_next;
}

void SessionRecorder::onSteps(const ros::MessageEvent<SessionSteps const>& event)
{
  const SessionStepsConstPtr group = event.getConstMessage();
  if (group->steps.empty())
    throw InputError(names::kSessionSteps, "steps", "is empty");
  for (std::size_t k = 0; k < group->steps.size(); ++k)
  {
    requireUsable(group->steps[k], scene_.instruments.size());
    if (group->steps[k].step != group->steps.front().step + k)
      throw InputError(names::kSessionSteps, "steps", "do not follow each other");
  }
  steps_source_.require(event.getPublisherName());
  if (!isNext(*group))
    throw InputError(names::kSessionSteps, "steps",
                     "do not follow the step before: a message was lost, or is another's");
  for (const DriveApplied& step : group->steps)
    recordStep(boost::shared_ptr<const DriveApplied>(group, &step), event.getReceiptTime());
}

void SessionRecorder::recordStep(const DriveAppliedConstPtr& step, ros::Time time)
{
  handled_ = step->step + 1;
  if (!isRecording() || durationIsOver())
    return;
  recording_->results.add(*step);
  last_step_ = ros::SteadyTime::now();
  recording_->bag.write(node_.resolveName(names::kDriveApplied), time, step);
  recordSetpoints(*step, time);
}

/** Records setpoint_js of all instruments, derived from drive/applied: rod_dynamics then need not publish it at the
 * step rate. */
void SessionRecorder::recordSetpoints(const DriveApplied& drive, ros::Time time)
{
  const std::size_t hands = std::min({scene_.instruments.size(), drive.insertion.size(), drive.rotation.size(),
                                      drive.pressure.size(), drive.hand_force.size(), drive.hand_torque.size()});
  if (!recording_->joints.passes(static_cast<double>(drive.step) * scene_.solver.time_step))
    return;
  for (std::size_t k = 0; k < hands; ++k)
    recordJoints(k, names::kSetpointJs, {drive.insertion[k], drive.rotation[k], drive.pressure[k]}, drive.hand_force[k],
                 drive.hand_torque[k], drive.header.stamp, time);
}

/** Records measured_js of all instruments, derived from rod/state_visual. */
void SessionRecorder::recordMeasurements(const RodStateVisual& rod, ros::Time time)
{
  const std::size_t hands = std::min({scene_.instruments.size(), rod.insertion.size(), rod.rotation.size(),
                                      rod.pressure.size(), rod.hand_force.size(), rod.hand_torque.size()});
  for (std::size_t k = 0; k < hands; ++k)
    recordJoints(k, names::kMeasuredJs, {rod.insertion[k], rod.rotation[k], rod.pressure[k]}, rod.hand_force[k],
                 rod.hand_torque[k], rod.header.stamp, time);
}

void SessionRecorder::recordJoints(std::size_t k, const char* topic, const JointValues& values, double force,
                                   double torque, ros::Time stamp, ros::Time time)
{
  const instrument::Instrument& instrument = scene_.instruments[k].instrument;
  const auto joints = boost::make_shared<sensor_msgs::JointState>();
  joints->header.stamp = stamp;
  joints->header.frame_id = names::kIntroducerFrame;
  toMessage(instrument.balloon.has_value(), values, force, torque, *joints);
  recording_->bag.write(node_.resolveName(names::kInstruments + instrument.name + topic), time, joints);
}

void SessionRecorder::onRod(const ros::MessageEvent<RodStateVisual const>& event)
{
  if (!isRecording())
    return;
  const RodStateVisual& rod = *event.getMessage();
  requireKnown(rod, names::kRodStateVisual);
  requireUsable(rod, scene_.instruments.size());
  recording_->results.add(rod);
  if (recording_->error.empty())
    recording_->error = recording_->results.trajectoryError();
  recordMeasurements(rod, event.getReceiptTime());
  if (recording_->pose.passes(rod.time))
    recording_->bag.write(node_.resolveName(names::kRodStateVisual), event);
}

void SessionRecorder::onContacts(const ros::MessageEvent<ContactForces const>& event)
{
  if (!isRecording())
    return;
  const ContactForces& forces = *event.getMessage();
  requireKnown(forces, names::kContactForces);
  requireUsable(forces);
  if (recording_->contacts.passes(static_cast<double>(forces.step) * scene_.solver.time_step))
    recording_->bag.write(node_.resolveName(names::kContactForces), event);
}

void SessionRecorder::onForceMap(const ros::MessageEvent<ContactForceMap const>& event)
{
  if (!isRecording())
    return;
  requireKnown(*event.getConstMessage(), names::kContactForceMap);
  requireUsable(*event.getConstMessage());
  recording_->results.add(event.getConstMessage());
  recording_->bag.write(node_.resolveName(names::kContactForceMap), event);
}

void SessionRecorder::onVessel(const ros::MessageEvent<VesselMesh const>& event)
{
  if (info_published_)
    return;                               // later meshes are in vessel/wall_displacement already
  fromMessage(*event.getConstMessage());  // throws for an invalid one
  info_.mesh_hash = event.getConstMessage()->content_hash;
  publishInfo();
  const std::string topic = node_.resolveName(names::kVesselMesh);
  // The mesh before the centreline, as the metrics need them: maps are in the order of their keys.
  auto& begin = latched_["1 " + topic] = [topic, event](Recording& recording)
  {
    recording.results.add(event.getConstMessage());
    recording.bag.write(topic, ros::Time::now(), event);
  };
  if (isRecording())
    begin(*recording_);
}

void SessionRecorder::onCentreline(const ros::MessageEvent<VesselCentreline const>& event)
{
  fromMessage(*event.getConstMessage());  // throws for an invalid one
  lesionsFromMessage(*event.getConstMessage());
  const std::string topic = node_.resolveName(names::kVesselCentreline);
  auto& begin = latched_["2 " + topic] = [topic, event](Recording& recording)
  {
    recording.results.add(*event.getConstMessage());
    recording.bag.write(topic, ros::Time::now(), event);
  };
  if (isRecording())
    begin(*recording_);
}

void SessionRecorder::onImage(const ros::MessageEvent<sensor_msgs::Image const>& event)
{
  if (!isRecording())
    return;
  requireUsable(*event.getConstMessage());
  recording_->results.report().addFluoroscopyFrame();
  if (scene_.record.x_ray_frames)
    recording_->bag.write(node_.resolveName(names::kFluoroscopyImage), event);
  if (settings_.picture_interval > 0 &&
      recording_->frames++ % static_cast<std::uint64_t>(settings_.picture_interval) == 0)
    savePicture(event.getMessage());
}

void SessionRecorder::savePicture(const sensor_msgs::ImageConstPtr& image)
{
  if (image->encoding != sensor_msgs::image_encodings::MONO8 || image->step != image->width)
    return;
  const std::string name = formatted("frame_%06llu.png", static_cast<unsigned long long>(recording_->frames - 1));
  recording_->results.report().addFluoroscopyPicture();
  const std::string file = recording_->path("fluoroscopy/") + name;
  recording_->bag.run(
      [image, file]
      { fluoroscopy::writePng(file, static_cast<int>(image->width), static_cast<int>(image->height), image->data); });
}

void SessionRecorder::onDiagnostics(const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& event)
{
  if (!isRecording())
    return;
  recording_->results.add(*event.getMessage());
  recording_->bag.write(node_.resolveName(names::kDiagnostics), event);
}

bool SessionRecorder::durationIsOver() const
{
  return settings_.stop_at_duration && recording_->results.report().lastStep() >= stepsOf(scene_, settings_);
}

void SessionRecorder::logProgress()
{
  const double now = recording_->results.report().simulatedTime();
  if (now < logged_time_ + 1.0)
    return;
  logged_time_ = std::floor(now);
  ROS_INFO("%.0f of %.0f s simulated, insertion %.1f mm, hand force %.3f N", now, scene_.duration,
           1e3 * recording_->results.report().insertedLength(), recording_->results.report().handForce().final());
}

void SessionRecorder::onTimer(const ros::SteadyTimerEvent&)
{
  // By the steady clock: simulated time may stand still.
  if ((ros::SteadyTime::now() - diagnosed_).toSec() >= kDiagnosticsPeriod)
  {
    diagnosed_ = ros::SteadyTime::now();
    publishDiagnostics(diagnostics_);
  }
  if (!isRecording())
    return;
  logProgress();
  if (!settings_.stop_at_duration)
    return;
  const double silence = (ros::SteadyTime::now() - last_step_).toSec();
  const double patience = recording_->results.report().steps() == 0 ? settings_.start_patience : settings_.patience;
  // Messages of the last steps on other topics may arrive after session/steps.
  const bool is_settled = silence > kLongestSettling || (silence > kSettling && recording_->results.hasFinalMap());
  if (durationIsOver() && is_settled)
    endWith("");
  else if (durationIsOver())
    return;
  else if (silence > patience)
    endWith("no step of the simulation for " + std::to_string(static_cast<int>(silence)) +
            " s; the diagnostics of rod_dynamics and contact hold the reason");
}

bool SessionRecorder::onStop(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  stop();
  response.success = complete_;
  const std::string verdict = recording_->results.verdict();
  response.message =
      (verdict.empty() ? "" : verdict + ": ") + recording_->path(verdict.empty() ? "report.json" : "metrics.html");
  return true;
}

void SessionRecorder::endWith(const std::string& error)
{
  if (!error.empty())
  {
    recording_->error = error;
    ROS_ERROR("%s", error.c_str());
  }
  finish();
  ros::requestShutdown();
}

void SessionRecorder::fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) const
{
  const std::string bag_error = recording_->bag.error();
  if (!bag_error.empty())
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "recording ended early: " + bag_error);
  else if (!recording_->error.empty())
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, recording_->error);
  else if (recording_->bag.dropped() > 0)  // without an error only the queue drops messages
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "messages were dropped: the disk is too slow");
  else
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, isRecording() ? "recording" : "finished");
  status.add("steps recorded", recording_->results.report().steps());
  status.add("messages recorded", recording_->bag.messages());
  status.add("messages dropped", recording_->bag.dropped());
  status.add("recording [bytes]", recording_->bag.bytes());
  IgnoredMessages::ofProcess().diagnose(status);
}

bool SessionRecorder::finish()
{
  if (finished_)
    return complete_;
  finished_ = true;
  subscribers_.clear();
  progress_publisher_.shutdown();  // the simulation waits for this recorder no longer
  stop();
  return complete_;
}

void SessionRecorder::stop()
{
  if (stopped_)
    return;
  stopped_ = true;
  complete_ = closeRecording() && complete_;
}

/** Closes the bag and writes the report of the recording. @return true when everything was written */
bool SessionRecorder::closeRecording()
{
  Recording& recording = *recording_;
  SessionEnd end;
  end.header.stamp = ros::Time::now();
  end.steps = recording.results.report().lastStep();
  recording.bag.writeLatched(node_.resolveName(names::kSessionEnd), end);
  recording.bag.close();
  results::RecordingOutcome outcome;
  outcome.file = recording.bag.file();
  outcome.bytes = recording.bag.bytes();
  outcome.messages = recording.bag.messages();
  outcome.dropped = recording.bag.dropped();
  outcome.error = recording.bag.error();
  const bool written =
      recording.results.write(outcome, recording.error) && outcome.error.empty() && recording.error.empty();
  if (const std::string verdict = recording.results.verdict(); !verdict.empty())
    ROS_INFO("%s", verdict.c_str());
  ROS_INFO("recorded %llu steps in %s", static_cast<unsigned long long>(recording.results.report().steps()),
           recording.folder.c_str());
  return written;
}

void SessionRecorder::onRun(const ros::MessageEvent<SimulationRun const>& event)
{
  const SimulationRunConstPtr run = event.getConstMessage();
  if (run_ != 0 && run->run <= run_)
    return;
  if (run->run == 0 || (run_ != 0 && run->run > run_ + 1))
    throw InputError(names::kSimulationRun, "run", "must be 1, or follow run " + std::to_string(run_));
  next_ = run;
  next_since_ = ros::SteadyTime::now();
}

/** Records the announced run. The first run belongs to the recording that is open. */
void SessionRecorder::beginRun()
{
  const SimulationRun& run = *next_;
  if (run_ != 0 || stopped_)
  {
    stop();
    const std::string folder = settings_.folder + "/run_" + std::to_string(run.run);
    recording_ = std::make_unique<Recording>(scene_, createRecordingFolder(folder), stepsOf(scene_, settings_));
    stopped_ = false;
    if (info_published_)
      recording_->bag.writeLatched(node_.resolveName(names::kSessionInfo), info_);
    for (const auto& [key, begin] : latched_)
      begin(*recording_);
    logged_time_ = 0.0;
    last_step_ = ros::SteadyTime::now();
    ROS_INFO("recording run %u in %s", run.run, folder.c_str());
  }
  handled_ = run_ == 0 ? std::max(handled_, run.first_step) : run.first_step;
  run_ = run.run;
  recording_->results.report().setFirstStep(run.first_step);
  recording_->bag.writeLatched(node_.resolveName(names::kSimulationRun), run);
  next_.reset();
}

void SessionRecorder::update()
{
  if (finished_)
    return;
  try
  {
    // The last steps of the previous run may arrive after the announcement.
    const bool is_complete =
        next_ &&
        (run_ == 0 || stopped_ || recording_->results.report().lastStep() >= next_->previous_steps || durationIsOver());
    if (is_complete || (next_ && (ros::SteadyTime::now() - next_since_).toSec() > kLongestSettling))
      beginRun();
  }
  catch (const InputError& error)
  {
    endWith(error.what());
    return;
  }
  publishProgress();
}

/** Publishes the number of recorded steps on change, unless the disk is too slow for them. */
void SessionRecorder::publishProgress()
{
  const ros::SteadyTime now = ros::SteadyTime::now();
  if ((progress_.run == run_ && progress_.steps == handled_) ||
      (progress_.run == run_ && (now - reported_).toSec() < kProgressPeriod) || recording_->bag.isHalfFull())
    return;
  reported_ = now;
  progress_.header.stamp = ros::Time::now();
  progress_.run = run_;
  progress_.steps = handled_;
  progress_publisher_.publish(progress_);
}

}  // namespace endovascular_sim::nodes
