#include "nodes/rod_dynamics/step_obstacles.h"

#include <utility>

#include "nodes/rod_dynamics/control/step_scheduler.h"
#include "nodes/runtime/node_program.h"

namespace endovascular_sim::nodes
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kMostAhead = 5000;  ///< lead before the recorder: half of its queue [steps]
constexpr double kBriefWait = 1.0;          ///< wait for the recorder or the flow that is no pause [s]
constexpr double kSlice = 0.01;             ///< duration of one wait for the flow [s]
constexpr auto kPausedByClient = "paused by simulation/pause; continues with simulation/resume";
constexpr auto kContactLost = "no response of the contact node or of the vessel server behind it";
constexpr auto kFlowLost = "hemodynamics does not respond";
constexpr auto kRecorderBehind = "the recorder lags behind; continues when it has caught up";

}  // namespace

StepObstacles::StepObstacles(GraphSimulation& simulation, RecorderProgress& recorder, Pace pace, double pause_after,
                             std::function<bool()> is_over)
  : simulation_(simulation), recorder_(recorder), pace_(pace), pause_after_(pause_after), is_over_(std::move(is_over))
{
}

std::string StepObstacles::find(bool is_held)
{
  if (is_paused_)
    return kPausedByClient;
  if (isContactMissing() || simulation_.needsWall())
    return kContactLost;
  if (isFlowMissing(is_held))
    return kFlowLost;
  return isRecorderBehind(is_held) ? kRecorderBehind : "";
}

bool StepObstacles::isFault(const std::string& reason)
{
  return reason == kContactLost || reason == kFlowLost;
}

bool StepObstacles::isContactSilent() const
{
  const RemoteContactSource* contacts = simulation_.contacts();
  if (contacts == nullptr || !contacts->silent())
    return false;
  const double silence = std::chrono::duration<double>(Clock::now() - contacts->silentSince()).count();
  return pace_ != Pace::kRealTime || silence > pause_after_;
}

/** Queries a lost contact node again. @return false when it is not lost, or has responded */
bool StepObstacles::isContactMissing()
{
  if (!isContactSilent())
  {
    is_listening_ = false;
    return false;
  }
  if (!is_listening_)
    simulation_.contacts()->startListening();
  is_listening_ = true;
  return !simulation_.contacts()->probe();
}

/** Waits for the flow as long as the hand does not notice it, and at the beginning of a run, where several beats are
 * computed. A request without an answer is repeated. */
bool StepObstacles::isFlowMissing(bool is_held)
{
  has_waited_ = false;
  if (!simulation_.needsFlow() || simulation_.flow()->isReady())
    return false;
  const bool is_first = simulation_.simulation().blood()->field() == nullptr;
  const double patience = is_held ? 0.0 : pace_ == Pace::kRealTime && !is_first ? pause_after_ : kBriefWait;
  const Clock::time_point end = Clock::now() + StepScheduler::period(patience);
  while (!simulation_.flow()->waitForAnswer(is_held ? 0.0 : kSlice))
  {
    if (Clock::now() >= end || is_over_())
      return true;
    countProgress();
  }
  has_waited_ = is_first;
  return false;
}

/** Outside of real time nothing but the recorder limits the rate of the steps: its queues must not overflow. A brief
 *  lag is waited for. */
bool StepObstacles::isRecorderBehind(bool is_held)
{
  if (pace_ == Pace::kRealTime)
    return false;
  const Clock::time_point end = Clock::now() + StepScheduler::period(is_held ? 0.0 : kBriefWait);
  while (!recorder_.isWithin(simulation_.simulation().steps(), kMostAhead))
  {
    if (Clock::now() >= end || is_over_())
      return true;
    countProgress();
    sleepUntil(Clock::now() + StepScheduler::period(1e-3));
  }
  return false;
}

}  // namespace endovascular_sim::nodes
