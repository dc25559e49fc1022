#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>

#include "common/error.h"
#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/SessionSteps.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "nodes/runtime/one_source.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

/** Queue length of topics at the step rate: 10 s of messages. */
constexpr std::uint32_t kStepQueue = 10000;

/** Sequence of the steps that arrive at the session node: which ones are there, and which messages belong to them. */
class StepSequence
{
public:
  /** @param time_step of the scene [s] */
  explicit StepSequence(double time_step) : time_step_(time_step) {}

  /** Accepts a group of steps if it follows the last one, or is the second group after a gap. A stray message has no
   *  effect.
   *  @throws InputError for another group, std::runtime_error for one of another publisher */
  void accept(const SessionSteps& group, const std::string& publisher)
  {
    source_.require(publisher);
    const std::uint64_t step = group.steps.front().step;
    const bool is_next = step == handled_ || step == after_gap_;
    after_gap_ = step + group.steps.size();
    if (!is_next)
      throw InputError(names::kSessionSteps, "steps",
                       "do not follow the step before: a message was lost, or is another's");
  }

  /** Number of steps, up to the last one that has arrived. */
  std::uint64_t handled() const { return handled_; }
  void setHandled(std::uint64_t steps) { handled_ = steps; }

  /** Number of steps before the first one of the recording; messages of earlier steps do not belong to it. */
  std::uint64_t first() const { return first_; }

  /** Reports whether a message belongs to a step before the first one of the recording. */
  template <typename Message>
  bool isBefore(const Message& message) const
  {
    return message.step < first_;
  }

  /** Begins at a step: the next group of steps begins there. */
  void beginAt(std::uint64_t first) { first_ = handled_ = first; }

  /** @throws InputError for a message that is further ahead of session/steps than its queue is long, or whose time is
   *          not that of its step */
  template <typename Message>
  void requireKnown(const Message& message, const std::string& topic) const
  {
    if (message.step > handled_ + kStepQueue)
      throw InputError(topic, "step", "is " + std::to_string(message.step) + ", far ahead of the simulation");
    if constexpr (std::is_same_v<Message, RodStateVisual> || std::is_same_v<Message, SessionSample> ||
                  std::is_same_v<Message, TreatmentVisual> || std::is_same_v<Message, MotionState> ||
                  std::is_same_v<Message, ContrastState>)
      if (!(std::abs(message.time - static_cast<double>(message.step + 1) * time_step_) < time_step_))
        throw InputError(topic, "time", "is not that of its step");
  }

private:
  double time_step_;
  OneSource source_;
  std::uint64_t first_ = 0;
  std::uint64_t handled_ = 0;
  std::uint64_t after_gap_ = 0;  ///< step after the last one that has arrived, whether or not it followed
};

}  // namespace endovascular_sim::nodes
