#include <algorithm>

#include "common/error.h"
#include "common/text/format.h"
#include "endovascular_sim/SimulationRun.h"
#include "nodes/rod_dynamics/rod_dynamics_node.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/ros_names.h"

// Services of RodDynamicsNode. They are called between two steps.

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint32_t kMostSteps = 100000;  ///< of one call [steps]
constexpr double kClearance = 10.0;           ///< longest wait of a call for the contact node and the recorder [s]
constexpr double kNextRecording = 60.0;       ///< longest wait for the begin of a recording [s]

}  // namespace

SimulationServices::Operations RodDynamicsNode::operations()
{
  std::function<std::string(const InjectContrast::Request&)> inject;
  if (simulation_.scene().contrast)
    inject = [this](const InjectContrast::Request& request) { return simulation_.inject(request); };
  return {[this] { return pauseByClient(); },
          [this] { return resumeByClient(); },
          [this] { return reset(); },
          [this] { return simulation_.save(); },
          [this](const std::string& state, const std::string& origin) { return continueFrom(state, origin); },
          [this](std::uint32_t step) { return goToStep(step); },
          [this](const StepSimulation::Request& request, StepSimulation::Response& response)
          { stepByClient(request, response); },
          [this](ContinueRecording::Response& response) { continueRecording(response); },
          inject};
}

std::string RodDynamicsNode::pauseByClient()
{
  obstacles_.setPaused(true);
  return "paused at step " + std::to_string(simulation_.simulation().steps());
}

std::string RodDynamicsNode::resumeByClient()
{
  obstacles_.setPaused(false);
  return "continues at step " + std::to_string(simulation_.simulation().steps());
}

std::string RodDynamicsNode::reset()
{
  const std::uint64_t previous_steps = simulation_.simulation().steps();
  simulation_.reset();
  return beginRun("", previous_steps);
}

std::string RodDynamicsNode::continueFrom(const std::string& state, const std::string& origin)
{
  const std::uint64_t previous_steps = simulation_.simulation().steps();
  simulation_.load(state, origin);
  return beginRun(state, previous_steps);
}

/** @param number of the step, from 1; 0: the present one */
std::string RodDynamicsNode::goToStep(std::uint32_t number)
{
  const std::size_t step = number == 0 ? step_states_.present() : number - 1U;
  const std::string* state = step_states_.at(step);
  if (!simulation_.isGuided())
    throw InputError(names::kGoToStep, "", "a person repeats steps of a guided procedure only; this scene has none");
  if (state == nullptr)
    throw InputError(names::kGoToStep, "step",
                     "step " + std::to_string(step + 1) +
                         " was not begun yet; start the lesson with step:=" + std::to_string(step + 1));
  return continueFrom(std::string(*state), "step " + std::to_string(step + 1) + " of the procedure");
}

/** @param state saved state at the beginning; empty: the beginning of the scene */
void RodDynamicsNode::announceRun(const std::string& state, std::uint64_t previous_steps)
{
  SimulationRun run;
  run.header.stamp = simulation_.clock().stamp(simulation_.simulation().steps());
  run.run = ++run_;
  run.first_step = run_began_ = simulation_.simulation().steps();
  run.previous_steps = previous_steps;
  run.state.assign(state.begin(), state.end());
  run_publisher_.publish(run);
  simulation_.publishControls(run_);
}

/** Fills the response with the present run and its state, before the next step. The steps before it are published
 * first, so that a group of steps begins there. */
void RodDynamicsNode::continueRecording(ContinueRecording::Response& response)
{
  simulation_.publishWaitingSteps();
  SimulationRun& run = response.run;
  run.header.stamp = simulation_.clock().stamp(simulation_.simulation().steps());
  run.run = run_;
  run.first_step = run.previous_steps = simulation_.simulation().steps();
  run.continued = 1;
  response.run_began = run_began_;
  try
  {
    const std::string state = simulation_.save();
    run.state.assign(state.begin(), state.end());
    response.success = 1;
  }
  catch (const InputError& error)
  {
    response.success = 0;
    response.message = error.what();
    ROS_WARN("a further recording begins without a state: %s", error.what());
  }
}

/** Announces a run, and waits until the recorder has closed its recording and begun the next one.
 *  @throws InputError when the recorder does not respond */
std::string RodDynamicsNode::beginRun(const std::string& state, std::uint64_t previous_steps)
{
  announceRun(state, previous_steps);
  hold_.begin(0.0);
  const Clock::time_point end = Clock::now() + StepScheduler::period(kNextRecording);
  while (!recorder_.hasBegun(run_) && !isOver())
  {
    if (Clock::now() > end)
      throw InputError("session", "", "has not begun the next recording within 60 s: steps may be missing in it");
    hold_.publish();
    countProgress();
    sleepUntil(Clock::now() + StepScheduler::period(1e-3));
  }
  simulation_.publishBeginning();
  return formatted("run %u begins at %.1f s", run_, simulation_.simulation().time());
}

void RodDynamicsNode::stepByClient(const StepSimulation::Request& request, StepSimulation::Response& response)
{
  observer_->begin();
  response.message = refusalOf(request);
  if (response.message.empty())
    response.message = simulation_.drives().give(names::kSimulationStep, request.commands);
  if (response.message.empty())
    response.message = takeSteps(request.steps);
  simulation_.publishWaitingSteps();
  response.success = response.message.empty() ? 1 : 0;
  simulation_.clock().publish(simulation_.simulation().steps());
  observer_->report(simulation_.simulation(), simulation_.instruments(), simulation_.drives(),
                    simulation_.clock().stamp(simulation_.simulation().steps()), response);
}

/** Reason for which a call cannot be executed at all; empty without one. */
std::string RodDynamicsNode::refusalOf(const StepSimulation::Request& request) const
{
  if (pace_ != Pace::kStepped)
    return std::string("the pace is ") + nameOf(pace_) +
           "; clients take the steps only with the pace stepped: start with pace:=stepped";
  if (obstacles_.isPaused())
    return "the simulation is paused; call simulation/resume first";
  if (request.steps > kMostSteps)
    return "steps is " + std::to_string(request.steps) + "; must be at most " + std::to_string(kMostSteps);
  return "";
}

/** Takes the steps of a call. @return reason for which not all of them were taken; else empty */
std::string RodDynamicsNode::takeSteps(std::uint32_t steps)
{
  StepScheduler scheduler(simulation_.scene().solver.time_step);
  for (std::uint32_t taken = 0; taken < steps; ++taken)
  {
    countProgress();
    std::string reason = waitForClearance();
    if (reason.empty() && isAtEnd())
      reason = "the end of the simulated time, parameter seconds, is reached";
    if (!reason.empty())
      return reason + "; " + std::to_string(taken) + " of " + std::to_string(steps) + " steps were taken";
    step(scheduler, Clock::now());
    observer_->addStep(simulation_.simulation());
  }
  return "";
}

/** Waits until a step can be taken. @return reason for which it still cannot; else empty */
std::string RodDynamicsNode::waitForClearance()
{
  const Clock::time_point end = Clock::now() + StepScheduler::period(kClearance);
  std::string reason = obstacles_.find(hold_.isActive());
  while (!reason.empty() && Clock::now() < end && !isOver())
  {
    hold_.begin(0.0);
    hold_.announce(reason, StepObstacles::isFault(reason));
    hold_.publish();
    countProgress();
    sleepUntil(Clock::now() + StepScheduler::period(1e-3));
    reason = obstacles_.find(hold_.isActive());
  }
  if (isOver())
    return "the simulation ends";
  if (reason.empty() && hold_.isActive())
    hold_.release();
  return reason;
}

}  // namespace endovascular_sim::nodes
