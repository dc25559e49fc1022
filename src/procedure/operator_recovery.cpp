#include <algorithm>
#include <cmath>
#include <string>

#include "procedure/operator.h"

// Recovery of the scripted operator: retries and loss of support.

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kProgress = 2e-3;       // displacement of the tip that counts as progress [m]
constexpr double kModeLimit = 8.0;       // time limit of each mode of a recovery [s]
constexpr double kPullBackSpeed = 0.02;  // speed of pulling back [m/s]
constexpr double kRecoveryDepth = 0.05;  // distance of the tip behind the tip of the support after its withdrawal [m]

}  // namespace

bool Operator::isStalled(const InstrumentView& view, double time)
{
  const bool outside = view.hand.insertion <= 0.0;
  if (outside ? std::abs(view.hand.insertion - progress_insertion_) > kProgress
              : (view.tip - progress_tip_).norm() > kProgress)
  {
    progress_time_ = time;
    progress_tip_ = view.tip;
    progress_insertion_ = view.hand.insertion;
  }
  return time - progress_time_ > hand_.patience;
}

/** Starts a retry. @return false if the number of retries is exhausted, which fails the step */
bool Operator::retry(Mode mode, const InstrumentView& view, const std::string& why)
{
  if (records_.back().retries == step().retry.times)
  {
    fail(&view, why + ", after " + std::to_string(records_.back().retries) + " retries");
    return false;
  }
  ++records_.back().retries;
  mode_ = mode;
  mode_insertion_ = view.hand.insertion;
  mode_rotation_ = view.hand.rotation;
  return true;
}

/** Executes the modes of a retry in sequence: leave the wrong branch, pull back, rotate. Each mode ends at its goal or
 *  after kModeLimit. */
void Operator::recover(const InstrumentView& view, double time)
{
  Hand& hand = hands_[static_cast<std::size_t>(active_)];
  const bool late = time - mode_time_ > kModeLimit;
  const scene::RetryScene& retry = step().retry;
  const auto enter = [this, &view, time](Mode mode)
  {
    mode_ = mode;
    mode_insertion_ = view.hand.insertion;
    mode_rotation_ = view.hand.rotation;
    mode_time_ = time;
  };
  if (mode_ == Mode::kLeaveBranch)
  {
    const bool out = view.branch_position.branch < 0 || on_way_[static_cast<std::size_t>(view.branch_position.branch)];
    if (out || late)
      return enter(Mode::kPullBack);
    hand.target_speed = insertionSpeed(view, -kPullBackSpeed);
  }
  else if (mode_ == Mode::kPullBack)
  {
    if (mode_insertion_ - view.hand.insertion >= retry.back || late)
      return enter(Mode::kRotate);
    hand.target_speed = insertionSpeed(view, -kPullBackSpeed);
  }
  else if (std::abs(view.hand.rotation - mode_rotation_) >= std::abs(retry.turn) || late)
  {
    enter(Mode::kExecute);
    progress_time_ = time;
    progress_tip_ = view.tip;
    progress_insertion_ = view.hand.insertion;
  }
  else
    hand.target_turn_speed = std::copysign(std::min(2.0, hand_.max_turn), retry.turn);
}

/** True if the tip of an instrument is in the support's branch or beyond. */
bool Operator::isSupportPosition(const InstrumentView& view) const
{
  return view.branch_position.branch >= 0 &&
         locator().pathBetween(entry_branch_, view.branch_position.branch)[static_cast<std::size_t>(support_branch_)];
}

/** True if, for longer than HandScene::patience, neither the support nor the active instrument has been in the
 *  support's branch. */
bool Operator::hasLostSupport(const Observation& observation)
{
  const auto at = [&observation](int instrument) -> const InstrumentView&
  { return observation.instruments[static_cast<std::size_t>(instrument)]; };
  if (support_ < 0 || isSupportPosition(at(support_)) || isSupportPosition(at(active_)))
    lost_since_ = -1.0;
  else if (lost_since_ < 0.0)
    lost_since_ = observation.time;
  return lost_since_ >= 0.0 && observation.time - lost_since_ > hand_.patience;
}

/** Starts the recovery of the support, or fails the procedure after too many losses. */
void Operator::handleLostSupport(const InstrumentView& view, double time)
{
  const auto lost = std::count_if(records_.begin(), records_.end(),
                                  [this](const StepRecord& record)
                                  { return record.step == current_ && record.outcome == Progress::kSupportLost; });
  if (lost >= step().support.times)
    return fail(&view, step().support.instrument + " has left " + step().support.tip_in + " repeatedly");
  mode_ = Mode::kRecoverSupport;
  mode_time_ = time;
}

/** Withdraws the instrument into its support and then resumes from an earlier step. */
void Operator::recoverSupport(const Observation& observation)
{
  const InstrumentView& view = observation.instruments[static_cast<std::size_t>(active_)];
  const double end = observation.instruments[static_cast<std::size_t>(support_)].hand.insertion - kRecoveryDepth;
  if (view.hand.insertion > end && observation.time - mode_time_ <= kModeLimit)
  {
    hands_[static_cast<std::size_t>(active_)].target_speed = insertionSpeed(view, -kPullBackSpeed);
    return;
  }
  records_.back().outcome = Progress::kSupportLost;
  begun_ = false;
  const auto again =
      std::find_if(steps_.begin(), steps_.end(),
                   [this](const scene::StepScene& one) { return one.phase == step().support.again_from; });
  current_ = static_cast<std::size_t>(again - steps_.begin());
}

}  // namespace endovascular_sim::procedure
