#include "nodes/rod_dynamics/rod_dynamics_node.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <thread>
#include <utility>

#include <diagnostic_updater/diagnostic_updater.h>

#include "common/error.h"
#include "endovascular_sim/SimulationRun.h"
#include "nodes/rod_dynamics/instruments/unread_topics.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/ignored_messages.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/parameters.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kBetweenCalls = 10e-3;     ///< time between two calls of simulation/step in which forces stay [s]
constexpr double kPauseAfter = 15e-3;       ///< silence of the contact node that causes a pause in real time [s]
constexpr double kRecorderTimeout = 10.0;   ///< longest wait for a recorder [s]
constexpr double kRest = 1e-3;              ///< duration of one sleep that avoids real-time throttling [s]
constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]

double seconds(std::chrono::steady_clock::duration time)
{
  return std::chrono::duration<double>(time).count();
}

/** Thread with ordinary scheduling that publishes diagnostics periodically, and a last time when it ends. */
class DiagnosticsThread
{
public:
  explicit DiagnosticsThread(std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)> diagnose)
    : thread_([this, diagnose = std::move(diagnose)] { loop(diagnose); })
  {
  }
  ~DiagnosticsThread()
  {
    stop_ = true;
    thread_.join();
  }
  DiagnosticsThread(const DiagnosticsThread&) = delete;
  DiagnosticsThread& operator=(const DiagnosticsThread&) = delete;

private:
  void loop(const std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)>& diagnose) const
  {
    leaveRealTime();
    diagnostic_updater::Updater updater;
    updater.setHardwareID("none");
    updater.add("simulation", diagnose);
    while (!stop_ && ros::ok())
    {
      publishDiagnostics(updater);
      ros::WallDuration(kDiagnosticsPeriod).sleep();
    }
    publishDiagnostics(updater);
  }

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace

RodDynamicsNode::RodDynamicsNode(const ros::NodeHandle& node, const ros::NodeHandle& parameters, scene::Scene scene,
                                 std::function<SchedulingGrant()> request)
  : node_(node),
    parameters_(parameters),
    request_(std::move(request)),
    pace_(paceFrom(parameters_)),
    seconds_(numericParameter(parameters_, "seconds", 0.0, quantities::kDuration)),
    simulation_(node_, parameters_, std::move(scene), pace_),
    throttle_guard_(requiredIdleShare(), kRest),
    statistics_(simulation_.scene().solver.time_step),
    recorder_(node_),
    run_publisher_(node_.advertise<SimulationRun>(names::kSimulationRun, 1, true)),
    hold_(simulation_, statistics_),
    obstacles_(simulation_, recorder_, pace_,
               numericParameter(parameters_, "pause_after", kPauseAfter, quantities::kWait),
               [this] { return isOver(); })
{
  last_step_ = seconds_ > 0.0
                   ? static_cast<std::uint64_t>(std::llround(seconds_ / simulation_.scene().solver.time_step))
                   : ~std::uint64_t{0};
}

/** Real-time scheduling is of use in real time only: another pace would occupy its processor without a rest. */
void RodDynamicsNode::requestScheduling()
{
  if (pace_ == Pace::kRealTime)
    grant_ = request_();  // before the thread of the diagnostics, which has ordinary scheduling
  if (!grant_.granted)
    throttle_guard_ = RtThrottleGuard(0.0, kRest);
}

bool RodDynamicsNode::run()
{
  if (!simulation_.connect())
    return false;
  requestScheduling();
  {
    const DiagnosticsThread diagnostics(
        [this](diagnostic_updater::DiagnosticStatusWrapper& status)
        {
          statistics_.diagnose(grant_, status);
          for (const CommandReport& report : simulation_.drives().reports())
            diagnoseCommands(report, status);
          diagnoseUnread(unreadTopics(simulation_.scene(), node_.resolveName(names::kInstruments) + "/",
                                      publishedTopics(), ros::this_node::getName()),
                         status);
          IgnoredMessages::ofProcess().diagnose(status);
        });
    observer_ = std::make_unique<StepObserver>(simulation_.scene(), simulation_.centreline());
    simulation_.setState(drive::OperatingState::kEnabled, "");
    announceRun("", 0);
    waitForRecorder();
    services_ =
        std::make_unique<SimulationServices>(node_, operations(), parameters_.param<std::string>("state_folder", ""));
    ROS_INFO("running, pace %s", nameOf(pace_));
    runSteps();
    services_.reset();
    const bool is_without_vessel = simulation_.isWithoutVessel();
    if (is_without_vessel)
      ROS_WARN("vessel_server has ended at step %lu: the simulation ends, because the deformed wall is lost",
               static_cast<unsigned long>(simulation_.simulation().steps()));
    simulation_.publishEnd(is_without_vessel ? "vessel_server has ended" : "the session has ended");
  }
  return true;
}

/** Waits for the recorder, if the parameter `wait_for_recorder` announces one: a recording must begin with the first
 * step. The recorder reports the run when it is connected to the states for display, too. */
void RodDynamicsNode::waitForRecorder() const
{
  if (!parameters_.param("wait_for_recorder", false))
    return;
  const Clock::time_point end = Clock::now() + StepScheduler::period(kRecorderTimeout);
  while (ros::ok() && !(simulation_.isRecorded() && recorder_.isPresent() && recorder_.hasBegun(run_)))
  {
    if (Clock::now() > end)
    {
      ROS_WARN("no recorder within %.0f s: the recording will miss the first steps", kRecorderTimeout);
      return;
    }
    ros::WallDuration(0.01).sleep();
  }
}

void RodDynamicsNode::runSteps()
{
  StepScheduler scheduler(simulation_.scene().solver.time_step);
  scheduler.start(Clock::now());
  while (!isOver() && !isAtEnd())
  {
    countProgress();
    services_->serve(0.0);
    const Clock::time_point awake = Clock::now();
    if (pace_ == Pace::kRealTime && !hold_.isActive())
      sleepUntil(scheduler.next());
    const std::string reason = obstacles_.find(hold_.isActive());
    if (!reason.empty() || pace_ == Pace::kStepped)
    {
      hold(reason);
      continue;
    }
    const bool was_held = hold_.isActive();
    if (was_held)
      hold_.release();
    if (was_held || obstacles_.hasWaitedForFirstFlow())
      scheduler.start(Clock::now());
    step(scheduler, awake);
  }
}

/** Keeps the state where a step of a guided procedure has begun, so that it can be repeated. */
void RodDynamicsNode::keepStepState()
{
  if (!simulation_.isGuided() || simulation_.observer() == nullptr)
    return;
  try
  {
    step_states_.follow(*simulation_.observer(), [this] { return simulation_.save(); });
  }
  catch (const InputError& error)
  {
    ROS_WARN("this step of the procedure cannot be repeated: %s", error.what());
  }
}

/** @param awake time at which the loop has ended its work on the last step */
void RodDynamicsNode::step(StepScheduler& scheduler, Clock::time_point awake)
{
  const Clock::time_point begin = Clock::now();
  const double woken_late = awake < scheduler.next() ? seconds(begin - scheduler.next()) : 0.0;
  scheduler.begin(begin);
  simulation_.step();
  keepStepState();
  const Clock::time_point end = Clock::now();
  // Only real time has deadlines.
  const Clock::time_point deadline = pace_ == Pace::kRealTime ? scheduler.slotEnd() : end;
  statistics_.addStep(simulation_.simulation(), {begin, end, deadline, woken_late, simulation_.times()},
                      simulation_.isFaded());
  if (const RemoteContactSource* contacts = simulation_.contacts())
    statistics_.setContactSets(contacts->staleSets(), contacts->rejectedSets());
  if (pace_ != Pace::kRealTime)
    return;
  const double rest = throttle_guard_.after(seconds(begin - awake), seconds(end - begin));
  if (rest > 0.0)
    sleepUntil(end + StepScheduler::period(rest));
  if (scheduler.end(Clock::now()))
    statistics_.addDiscardedBacklog();
}

/** Takes no step for a short time, in which calls of the services are executed.
 *  @param reason empty while the simulation waits for a call of simulation/step */
void RodDynamicsNode::hold(const std::string& reason)
{
  hold_.begin(reason.empty() ? kBetweenCalls : 0.0);
  hold_.announce(reason, StepObstacles::isFault(reason));
  hold_.publish();
  services_->serve(hold_.untilNext());
}

bool RodDynamicsNode::isOver()
{
  return !ros::ok() || isStopRequested() || simulation_.isWithoutVessel();
}

}  // namespace endovascular_sim::nodes
