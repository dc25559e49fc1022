#include "nodes/session/session_recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/error.h"
#include "common/text/format.h"
#include "endovascular_sim/SessionEnd.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{

namespace
{

constexpr std::uint32_t kQueue = 1000;
constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]
constexpr double kProgressPeriod = 0.02;    ///< [s]
/** Time from the last step to the end of the recording, and its largest value without the wall forces of that step [s].
 */
constexpr double kSettling = 0.2;
constexpr double kLongestSettling = 3.0;

/** Number of steps after which the session ends; the largest number without an end. */
std::uint64_t stepsOf(const scene::Scene& scene, const RecorderSettings& settings)
{
  return settings.stop_at_duration ? static_cast<std::uint64_t>(std::llround(scene.duration / scene.solver.time_step))
                                   : std::numeric_limits<std::uint64_t>::max();
}

/** Error as a text: kind, instrument, and value with its unit. */
std::string textOf(const results::SessionError& error, const scene::Scene& scene)
{
  std::string text = error.kind + ": " + scene.instruments[static_cast<std::size_t>(error.instrument)].instrument.name;
  std::replace(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(error.kind.size()), '_', ' ');
  if (error.unit == "m")
    return text + formatted(", %.1f mm", 1e3 * error.value);
  return error.unit.empty() ? text : text + formatted(", %.2f %s", error.value, error.unit.c_str());
}

bool isSame(const results::SessionError& a, const results::SessionError& b)
{
  return a.kind == b.kind && a.instrument == b.instrument && a.time == b.time;
}

}  // namespace

SessionRecorder::SessionRecorder(const ros::NodeHandle& node, scene::Scene scene, RecorderSettings settings)
  : node_(node),
    scene_(std::move(scene)),
    settings_(std::move(settings)),
    recording_(
        std::make_unique<Recording>(scene_, createRecordingFolder(settings_.folder), stepsOf(scene_, settings_))),
    sequence_(scene_.solver.time_step)
{
  progress_publisher_ = node_.advertise<SessionProgress>(names::kSessionProgress, 1, true);
  runs_ = subscribeGuarded<SimulationRun>(node_, names::kSimulationRun, kQueue,
                                          [this](const auto& event) { onRun(event); });
  topics_.emplace(node_, scene_, settings_.picture_interval, sequence_);
  topics_->recordInto(recording_.get());
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
  const double silence = (ros::SteadyTime::now() - topics_->lastStep()).toSec();
  const double patience = recording_->results.report().steps() == 0 ? settings_.start_patience : settings_.patience;
  // Messages of the last steps on other topics may arrive after session/steps.
  const bool is_settled = silence > kLongestSettling || (silence > kSettling && recording_->results.hasFinalMap());
  if (recording_->isComplete() && is_settled)
    endWith("");
  else if (recording_->isComplete())
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
  runs_.shutdown();
  topics_->unsubscribe();
  progress_publisher_.shutdown();  // the simulation waits for this recorder no longer
  stop();
  return complete_;
}

void SessionRecorder::stop()
{
  if (stopped_)
    return;
  stopped_ = true;
  topics_->recordInto(nullptr);
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
    topics_->recordInto(recording_.get());
    logged_time_ = 0.0;
    topics_->setLastStep(ros::SteadyTime::now());
    ROS_INFO("recording run %u in %s", run.run, folder.c_str());
  }
  sequence_.setHandled(run_ == 0 ? std::max(sequence_.handled(), run.first_step) : run.first_step);
  run_ = run.run;
  recording_->results.report().setFirstStep(run.first_step);
  recording_->bag.writeLatched(node_.resolveName(names::kSimulationRun), run);
  if (!run.state.empty() && simulation::hasBalloon(scene_))
    topics_->recordWall(run.first_step);
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
        next_ && (run_ == 0 || stopped_ || recording_->results.report().lastStep() >= next_->previous_steps ||
                  recording_->isComplete());
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

/** Takes over the errors that were found since the last call. Those of a closed recording are in its report. */
void SessionRecorder::updateErrors()
{
  if (stopped_)
    return;
  std::vector<results::SessionError> errors = recording_->results.metrics().errors();
  if (errors.empty())
    progress_.last_error.clear();
  for (const results::SessionError& error : errors)
    if (std::none_of(errors_.begin(), errors_.end(),
                     [&](const results::SessionError& known) { return isSame(known, error); }))
      progress_.last_error = textOf(error, scene_);
  errors_ = std::move(errors);
}

/** Publishes the number of recorded steps and of errors on change, unless the disk is too slow for them. */
void SessionRecorder::publishProgress()
{
  const ros::SteadyTime now = ros::SteadyTime::now();
  const bool is_new_run = progress_.run != run_;
  if ((!is_new_run && (now - reported_).toSec() < kProgressPeriod) || recording_->bag.isHalfFull())
    return;
  reported_ = now;
  updateErrors();
  if (!is_new_run && progress_.steps == sequence_.handled() && progress_.errors == errors_.size())
    return;
  progress_.header.stamp = ros::Time::now();
  progress_.run = run_;
  progress_.steps = sequence_.handled();
  progress_.errors = static_cast<std::uint32_t>(errors_.size());
  progress_publisher_.publish(progress_);
}

}  // namespace endovascular_sim::nodes
