#include <algorithm>
#include <cmath>
#include <string>

#include "procedure/operator.h"

// What the scripted operator does when a step does not go as it should.

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kProgress = 2e-3;       // m that count as progress of a tip
constexpr double kManoeuvreLimit = 8.0;  // s for one pull back or turn
constexpr double kFastBack = 0.02;       // m/s, of pulling back
constexpr double kWithin = 0.05;  // m inside of what supports it: that is drawn back too before it finds its place

}  // namespace

bool Operator::stalls(const InstrumentView& view, double time)
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

/** @return false when he has tried often enough */
bool Operator::tryAgain(Mode mode, const InstrumentView& view, const std::string& why)
{
  if (records_.back().retries == step().retry.times)
  {
    fail(&view, why + ", after " + std::to_string(records_.back().retries) + " new tries");
    return false;
  }
  ++records_.back().retries;
  mode_ = mode;
  mode_insertion_ = view.hand.insertion;
  mode_rotation_ = view.hand.rotation;
  return true;
}

/** Out of a wrong branch, a little back, a turn. Each of them ends at its goal or when it takes too long. */
void Operator::manoeuvre(const InstrumentView& view, double time)
{
  Hand& hand = hands_[static_cast<std::size_t>(active_)];
  const bool late = time - mode_time_ > kManoeuvreLimit;
  const scene::RetryScene& retry = step().retry;
  const auto enter = [this, &view, time](Mode mode)
  {
    mode_ = mode;
    mode_insertion_ = view.hand.insertion;
    mode_rotation_ = view.hand.rotation;
    mode_time_ = time;
  };
  if (mode_ == Mode::kLeave)
  {
    const bool out = view.place.branch < 0 || on_way_[static_cast<std::size_t>(view.place.branch)];
    if (out || late)
      return enter(Mode::kBack);
    hand.wanted = pushed(view, -kFastBack);
  }
  else if (mode_ == Mode::kBack)
  {
    if (mode_insertion_ - view.hand.insertion >= retry.back || late)
      return enter(Mode::kTurn);
    hand.wanted = pushed(view, -kFastBack);
  }
  else if (std::abs(view.hand.rotation - mode_rotation_) >= std::abs(retry.turn) || late)
  {
    enter(Mode::kGo);
    progress_time_ = time;
    progress_tip_ = view.tip;
    progress_insertion_ = view.hand.insertion;
  }
  else
    hand.wanted_turn = std::copysign(std::min(2.0, hand_.max_turn), retry.turn);
}

/** Whether an instrument's tip is where what supports the step's one has to be, or beyond. */
bool Operator::isInPlace(const InstrumentView& view) const
{
  return view.place.branch >= 0 &&
         places_.wayBetween(entered_, view.place.branch)[static_cast<std::size_t>(support_branch_)];
}

/** Whether the instrument has come out of its support somewhere else, for longer than a breath moves it. */
bool Operator::missesSupport(const Observation& seen)
{
  const auto at = [&seen](int instrument) -> const InstrumentView&
  { return seen.instruments[static_cast<std::size_t>(instrument)]; };
  if (support_ < 0 || isInPlace(at(support_)) || isInPlace(at(active_)))
    lost_since_ = -1.0;
  else if (lost_since_ < 0.0)
    lost_since_ = seen.time;
  return lost_since_ >= 0.0 && seen.time - lost_since_ > hand_.patience;
}

/** On this step, unless it has lost its support too often: then on the procedure. */
void Operator::giveUp(const InstrumentView& view, double time)
{
  const auto lost = std::count_if(records_.begin(), records_.end(),
                                  [this](const StepRecord& record)
                                  { return record.step == current_ && record.outcome == Progress::kLost; });
  if (lost >= step().support.times)
    return fail(&view, step().support.instrument + " has left " + step().support.tip_in + " again and again");
  mode_ = Mode::kReturn;
  mode_time_ = time;
}

/** Draws the instrument back into what supported it; then goes on from an earlier step. */
void Operator::comeBack(const Observation& seen)
{
  const InstrumentView& view = seen.instruments[static_cast<std::size_t>(active_)];
  const double end = seen.instruments[static_cast<std::size_t>(support_)].hand.insertion - kWithin;
  if (view.hand.insertion > end && seen.time - mode_time_ <= kManoeuvreLimit)
  {
    hands_[static_cast<std::size_t>(active_)].wanted = pushed(view, -kFastBack);
    return;
  }
  records_.back().outcome = Progress::kLost;
  begun_ = false;
  const auto again =
      std::find_if(steps_.begin(), steps_.end(),
                   [this](const scene::StepScene& one) { return one.phase == step().support.again_from; });
  current_ = static_cast<std::size_t>(again - steps_.begin());
}

}  // namespace endovascular_sim::procedure
