#include "nodes/session/session_recorder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "common/error.h"
#include "common/text/format.h"
#include "common/text/one_line.h"
#include "endovascular_sim/ContinueRecording.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SessionMark.h"
#include "endovascular_sim/SessionVerdict.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/bag_results.h"
#include "nodes/session/error_text.h"
#include "nodes/session/session_parameters.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{

namespace
{

constexpr std::uint32_t kQueue = 1000;
constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]
constexpr double kProgressPeriod = 0.02;    ///< [s]
constexpr double kAttemptPeriod = 0.1;      ///< time between two attempts to continue a recording [s]
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

bool isSame(const results::SessionError& a, const results::SessionError& b)
{
  return a.kind == b.kind && a.instrument == b.instrument && a.time == b.time;
}

/** Marks of the expert. @param folder of its results; empty: none */
std::vector<results::Mark> expertMarks(const std::string& folder)
{
  if (folder.empty())
    return {};
  try
  {
    return results::marksOfFile(folder + "/metrics.json");
  }
  catch (const InputError& error)
  {
    ROS_WARN("no values of the expert: %s", error.what());
    return {};
  }
}

/** Marks of a trainee beside those of an expert, without header and texts. */
SessionVerdict toMessage(const std::vector<results::Mark>& marks, const std::vector<results::Mark>& expert)
{
  SessionVerdict verdict;
  verdict.passed = true;
  for (const results::Mark& mark : marks)
  {
    const auto same =
        std::find_if(expert.begin(), expert.end(), [&](const results::Mark& other) { return other.name == mark.name; });
    verdict.mark.push_back(mark.name);
    verdict.unit.push_back(mark.unit);
    verdict.value.push_back(mark.value);
    verdict.limit.push_back(mark.limit);
    verdict.mark_passed.push_back(mark.passed);
    verdict.expert.push_back(same == expert.end() ? std::nan("") : same->value);
    verdict.passed = verdict.passed && mark.passed;
  }
  return verdict;
}

}  // namespace

SessionRecorder::SessionRecorder(const ros::NodeHandle& node, scene::Scene scene, RecorderSettings settings)
  : node_(node),
    scene_(std::move(scene)),
    settings_(std::move(settings)),
    parameters_("~"),
    sequence_(scene_.solver.time_step),
    run_(settings_.is_stopped ? settings_.run : 0),
    awaits_state_(settings_.continues && !settings_.is_stopped),
    stopped_(settings_.continues)
{
  if (!settings_.continues)
    open(createRecordingFolder(settings_.folder), RunBags::nameOf(1));
  subscribe();
  if (awaits_state_)
    topics_->waitForState();
  else if (recording_)
    topics_->recordInto(recording_.get());
  diagnostics_.setHardwareID("none");
  diagnostics_.add("recording",
                   [this](diagnostic_updater::DiagnosticStatusWrapper& status) { fillDiagnostics(status); });
}

/** Subscribes to the graph, and offers the services. A recorder that continues has no progress yet: the simulation
 * would wait for it. */
void SessionRecorder::subscribe()
{
  if (!awaits_state_)
    progress_publisher_ = node_.advertise<SessionProgress>(names::kSessionProgress, 1, true);
  verdict_publisher_ = node_.advertise<SessionVerdict>(names::kSessionVerdict, 1, true);
  mark_publisher_ = node_.advertise<SessionMark>(names::kSessionMark, kQueue);
  runs_ = subscribeGuarded<SimulationRun>(node_, names::kSimulationRun, kQueue,
                                          [this](const auto& event) { onRun(event); });
  topics_.emplace(node_, scene_, settings_.picture_interval, sequence_, settings_.subject);
  start_ = node_.advertiseService(names::kSessionStart, &SessionRecorder::onStart, this);
  stop_ = node_.advertiseService(names::kSessionStop, &SessionRecorder::onStop, this);
  mark_ = node_.advertiseService(names::kSessionMark, &SessionRecorder::onMark, this);
  subject_ = node_.advertiseService(names::kSetSubject, &SessionRecorder::onSubject, this);
  timer_ = node_.createSteadyTimer(ros::WallDuration(0.1), &SessionRecorder::onTimer, this);
}

/** Opens a recording, and stores its place for the case that this process fails.
 *  @throws InputError when a file cannot be created */
void SessionRecorder::open(const std::string& folder, const std::string& bag_name)
{
  recording_ = std::make_unique<Recording>(scene_, folder, stepsOf(scene_, settings_), bag_name);
  stopped_ = false;
  obstacle_.clear();
  remember(folder);
}

void SessionRecorder::remember(const std::string& folder)
{
  settings_.run_folder = folder;
  settings_.run = run_;
  parameters_.setParam(session_parameters::kRunFolder, folder);
  parameters_.setParam(session_parameters::kRun, static_cast<int>(run_));
  parameters_.setParam(session_parameters::kStopped, stopped_);
}

/** Folder of a run's recording. */
std::string SessionRecorder::folderOf(std::uint32_t run) const
{
  if (run == settings_.run || settings_.run == 0)
    return settings_.run_folder;
  return settings_.folder + "/run_" + std::to_string(run);
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

/** Begins a further bag of the run while none is recorded, or after its early end. */
bool SessionRecorder::onStart(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  response.success = 0;
  if (finished_ || awaits_state_)
    response.message =
        finished_ ? "the session has ended" : "the recording continues as soon as the graph is connected";
  else if (isRecording() && recording_->bag.error().empty())
    response.message = "a recording is open: " + recording_->bag.file() + "; call session/stop first";
  if (!response.message.empty())
    return true;
  stop();
  tryToContinue();
  response.success = isRecording();
  if (response.success)
    response.message = recording_->bag.file();
  else
    response.message = obstacle_.empty() ? "rod_dynamics does not respond; try again" : obstacle_;
  return true;
}

/** Also stores the pseudonym for the case that this process fails. */
bool SessionRecorder::onSubject(SetSubject::Request& request, SetSubject::Response& response)
{
  response.success = isOneLine(request.subject);
  if (!response.success)
  {
    response.message = "subject must be one line of at most " + std::to_string(kLongestLine) +
                       " bytes in UTF-8, without control characters";
    return true;
  }
  settings_.subject = request.subject;
  parameters_.setParam(session_parameters::kSubject, request.subject);
  topics_->setSubject(request.subject);
  return true;
}

bool SessionRecorder::onMark(AddMark::Request& request, AddMark::Response& response)
{
  response.success = 0;
  if (request.text.empty() || !isOneLine(request.text))
    response.message =
        "text must be one line of 1 to " + std::to_string(kLongestLine) + " bytes in UTF-8, without control characters";
  else if (!isRecording())
    response.message = "no recording is open; call session/start first";
  if (!response.message.empty())
    return true;
  const auto mark = boost::make_shared<SessionMark>();
  mark->header.stamp = ros::Time::now();
  mark->step = lastStep();
  mark->time = static_cast<double>(mark->step) * scene_.solver.time_step;
  mark->text = request.text;
  mark_publisher_.publish(*mark);
  recording_->results.add(*mark);
  recording_->bag.write(node_.resolveName(names::kSessionMark), mark->header.stamp, mark);
  response.success = 1;
  response.message = formatted("at %.3f s", mark->time);
  return true;
}

bool SessionRecorder::onStop(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  if (!recording_)
  {
    awaits_state_ = false;
    parameters_.setParam(session_parameters::kStopped, true);
    response.success = 0;
    response.message = "no recording was open";
    return true;
  }
  const bool was_recording = isRecording();
  stop();
  if (was_recording)
    publishVerdict();
  parameters_.setParam(session_parameters::kStopped, true);
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
  over_ = true;
  finish();
}

void SessionRecorder::fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) const
{
  const std::string bag_error = recording_ ? recording_->bag.error() : std::string();
  if (!recording_ || !obstacle_.empty())
    status.summary(
        obstacle_.empty() ? diagnostic_msgs::DiagnosticStatus::WARN : diagnostic_msgs::DiagnosticStatus::ERROR,
        obstacle_.empty() ? "the recording continues when the graph is connected" : obstacle_);
  else if (!bag_error.empty())
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "recording ended early: " + bag_error);
  else if (!recording_->error.empty())
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, recording_->error);
  else if (recording_->bag.dropped() > 0)  // without an error only the queue drops messages
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "messages were dropped: the disk is too slow");
  else
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, isRecording() ? "recording" : "finished");
  IgnoredMessages::ofProcess().diagnose(status);
  if (!recording_)
    return;
  status.add("steps recorded", recording_->results.report().steps());
  status.add("messages recorded", recording_->bag.messages());
  status.add("messages dropped", recording_->bag.dropped());
  status.add("recording [bytes]", recording_->bag.bytes());
}

bool SessionRecorder::finish()
{
  if (finished_)
    return complete_;
  finished_ = true;
  runs_.shutdown();
  topics_->unsubscribe();
  if (progress_publisher_)
  {
    progress_.ended = 1;  // the simulation waits for this recorder no longer
    progress_publisher_.publish(progress_);
  }
  stop();
  return complete_;
}

void SessionRecorder::stop()
{
  if (stopped_)
    return;
  stopped_ = true;
  topics_->recordNothing();
  complete_ = closeRecording() && complete_;
}

/** Publishes the marks of a lesson, beside those of the expert. */
void SessionRecorder::publishVerdict()
{
  const std::vector<results::Mark> marks = recording_->results.metrics().marks();
  if (marks.empty())
    return;
  std::string expert;
  if (!node_.getParam(names::kExpertResults, expert))
    expert.clear();
  SessionVerdict verdict = toMessage(marks, expertMarks(expert));
  verdict.header.stamp = ros::Time::now();
  verdict.run = run_;
  verdict.verdict = recording_->results.verdict();
  verdict.page = std::filesystem::absolute(recording_->path("metrics.html")).string();
  verdict_publisher_.publish(verdict);
}

/** Closes the bag and writes the report of the recording. @return true when everything was written */
bool SessionRecorder::closeRecording()
{
  Recording& recording = *recording_;
  topics_->recordNewestPose(recording);
  topics_->recordNewestMap(recording);
  SessionEnd end;
  end.header.stamp = ros::Time::now();
  end.steps = recording.results.report().lastStep();
  end.step_limit = recording.steps;
  end.picture_interval = static_cast<std::uint32_t>(std::max(settings_.picture_interval, 0));
  end.wall_time = recording.results.report().wallTime();
  end.longest_pause = recording.results.report().longestPause();
  end.dropped = recording.bag.dropped();
  end.error = recording.error;
  recording.bag.writeLatched(node_.resolveName(names::kSessionEnd), end);
  recording.bag.close();
  results::RecordingOutcome outcome;
  outcome.file = recording.bag.file();
  outcome.bytes = recording.bag.bytes();
  outcome.messages = recording.bag.messages();
  outcome.dropped = recording.bag.dropped();
  outcome.error = recording.bag.error();
  outcome.previous = recording.previous;
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
  if (awaits_state_)
    return;  // rod_dynamics gives the present run with its state
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
  const bool is_further = run_ != 0 || stopped_;
  if (is_further)
  {
    stop();
    const std::string folder = settings_.folder + "/run_" + std::to_string(run.run);
    run_ = run.run;
    open(createRecordingFolder(folder), RunBags::nameOf(1));
    topics_->recordInto(recording_.get(), {run.first_step, ""});
    logged_time_ = 0.0;
    topics_->setLastStep(ros::SteadyTime::now());
    ROS_INFO("recording run %u in %s", run.run, folder.c_str());
    sequence_.beginAt(run.first_step);
  }
  else
  {
    sequence_.setHandled(std::max(sequence_.handled(), run.first_step));
    run_ = run.run;
    remember(settings_.run_folder);
  }
  recording_->results.report().setFirstStep(run.first_step);
  recording_->bag.writeLatched(node_.resolveName(names::kSimulationRun), run);
  if (!run.state.empty() && simulation::hasBalloon(scene_))
    topics_->recordWall(run.first_step);
  next_.reset();
}

/** Begins a further bag of the run if rod_dynamics gives its state. A failure is logged, and named by obstacle_. */
void SessionRecorder::tryToContinue()
{
  attempted_ = ros::SteadyTime::now();
  ContinueRecording call;
  if (!ros::service::call(node_.resolveName(names::kContinueRecording), call))
    return;  // rod_dynamics has not begun, or ends
  awaits_state_ = false;
  try
  {
    continueRun(call.response.run, call.response.run_began);
    if (!progress_publisher_)
      progress_publisher_ = node_.advertise<SessionProgress>(names::kSessionProgress, 1, true);
    ROS_INFO("recording from step %lu on in %s", static_cast<unsigned long>(call.response.run.first_step),
             recording_->bag.file().c_str());
  }
  catch (const InputError& error)
  {
    obstacle_ = error.what();
    ROS_ERROR("the recording does not continue: %s; call session/start when the reason is removed", error.what());
  }
}

/** @param run with the state from which the bag begins
 *  @param run_began number of steps before the first one of the run
 *  @throws InputError when the bag cannot be created */
void SessionRecorder::continueRun(const SimulationRun& run, std::uint64_t run_began)
{
  const std::string folder = folderOf(run.run);
  const RunBags bags(folder);
  if (bags.names().empty())
    createRecordingFolder(folder);
  run_ = run.run;
  next_.reset();
  open(folder, bags.nextName());
  recording_->previous = bags.names();
  recording_->frames = nextFrame(folder);
  sequence_.beginAt(run.first_step);
  topics_->recordInto(recording_.get(), {run.first_step, bags.lastName()});
  recording_->bag.writeLatched(node_.resolveName(names::kSimulationRun), run);
  recording_->results.report().setFirstStep(run_began);
  addFormerBags(bags, run, run_began);
  if (!run.state.empty() && simulation::hasBalloon(scene_))
    topics_->recordWall(run.first_step);
  topics_->setLastStep(ros::SteadyTime::now());
}

/** Adds what the former bags of the run hold to the results, names the gap behind them, and completes the last one. */
void SessionRecorder::addFormerBags(const RunBags& bags, const SimulationRun& run, std::uint64_t run_began)
{
  Recording& recording = *recording_;
  for (const std::string& name : bags.names())
    try
    {
      addBag(recording.path(name), recording.results);
    }
    catch (const InputError& error)
    {
      ROS_WARN("the report lacks a bag: %s", error.what());
    }
  SessionGap gap;
  gap.header.stamp = ros::Time::now();
  gap.first_step = std::max(run_began, bags.steps());
  gap.previous = bags.lastName();
  gap.next = bags.nextName();
  const bool has_gap = run.first_step > gap.first_step;
  if (has_gap)
  {
    gap.last_step = run.first_step - 1;
    recording.results.add(gap);
    recording.bag.writeLatched(node_.resolveName(names::kSessionGap), gap);
    ROS_WARN("steps %lu to %lu are not recorded", static_cast<unsigned long>(gap.first_step),
             static_cast<unsigned long>(gap.last_step));
  }
  if (bags.lastName().empty())
    return;
  try
  {
    const std::string topic = node_.resolveName(names::kSessionGap);
    bags.complete(topic.substr(0, topic.size() - std::string(names::kSessionGap).size()), has_gap ? &gap : nullptr);
  }
  catch (const InputError& error)
  {
    ROS_WARN("%s", error.what());
  }
}

void SessionRecorder::update()
{
  if (finished_)
    return;
  if (awaits_state_)
  {
    if (topics_->isConnected() && (ros::SteadyTime::now() - attempted_).toSec() > kAttemptPeriod)
      tryToContinue();
    return;
  }
  try
  {
    // The last steps of the previous run may arrive after the announcement.
    const bool is_complete =
        next_ && (run_ == 0 || stopped_ || lastStep() >= next_->previous_steps || recording_->isComplete());
    if (is_complete || (next_ && (ros::SteadyTime::now() - next_since_).toSec() > kLongestSettling))
      beginRun();
  }
  catch (const InputError& error)
  {
    next_.reset();
    obstacle_ = error.what();
    ROS_ERROR("the run is not recorded: %s; call session/start when the reason is removed", error.what());
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

/** Publishes the number of recorded steps and of errors on change, unless the disk is too slow for them. The simulation
 *  waits for the first message. */
void SessionRecorder::publishProgress()
{
  is_linked_ = is_linked_ || topics_->hasStates();
  if (!is_linked_)
    return;
  const ros::SteadyTime now = ros::SteadyTime::now();
  const bool is_new_run = progress_.run != run_;
  if (!progress_publisher_ || (!is_new_run && (now - reported_).toSec() < kProgressPeriod) ||
      (recording_ && recording_->bag.isHalfFull()))
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
