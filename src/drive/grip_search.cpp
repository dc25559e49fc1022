#include "drive/grip_search.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::drive
{
namespace
{

constexpr double kTolerance = 0.01;      // of the limit, by which the force may exceed it
constexpr double kUnder = 0.02;          // of the limit, by which the force of a hand that slips may be below it
constexpr double kStiffness = 1e5;       // N/m, of an instrument at a stop, where no other guess is known
constexpr double kLeastStride = 1e-8;    // m
constexpr double kLargestStride = 1e-3;  // m
constexpr double kLeastInterval = 1e-7;  // m between the two nearest trials
constexpr int kMaxTrials = 16;
constexpr int kMaxFalse = 2;    // trials on the same side, after which the next one is close to the other side
constexpr double kClose = 0.1;  // of the interval

/** Excess of a ratio of force and limit: linear below 1, and at a pole of the force linear in the position. */
double excessOf(double ratio)
{
  return ratio > 1.0 ? 1.0 - 1.0 / ratio : ratio - 1.0;
}

}  // namespace

bool GripSearch::isWithin(double force, double limit)
{
  return !(std::abs(force) > (1.0 + kTolerance) * limit);
}

/** Chooses the hand that slips.
 *  @return false without a hand beyond its limit that can slip, or one that has slipped too far */
bool GripSearch::choose(const std::vector<double>& force, const std::vector<double>& position)
{
  const auto excess = [&](std::size_t k) { return std::abs(force[k]) / hands_[k].limit; };
  const auto isStopped = [&](std::size_t k)
  { return force[k] > 0.0 ? position[k] <= hands_[k].least : position[k] >= hands_[k].most; };
  if (slipping_ && !isWithin(force[*slipping_], hands_[*slipping_].limit) && !isStopped(*slipping_))
    return true;
  std::optional<std::size_t> worst;
  for (std::size_t k = 0; k < hands_.size(); ++k)
    if (!isWithin(force[k], hands_[k].limit) && !isStopped(k) && (!worst || excess(k) > excess(*worst)))
      worst = k;
  if (worst)
  {
    slipping_ = worst;
    begin(force[*worst], position[*worst]);
    return true;
  }
  // A hand that has slipped too far.
  return slipping_ && position[*slipping_] != wanted_[*slipping_] && outside_.known &&
         sign_ * force[*slipping_] < (1.0 - kUnder) * hands_[*slipping_].limit &&
         std::abs(outside_.position - position[*slipping_]) > kLeastInterval;
}

/** Begins with a hand beyond its limit. The position before the step, if the hand has moved on against the force, is
 *  taken for one within the limit, until trials show otherwise. */
void GripSearch::begin(double force, double position)
{
  const GrippingHand& hand = hands_[*slipping_];
  sign_ = force > 0.0 ? 1.0 : -1.0;
  const double travel = position - hand.before;
  const double stiffness = travel != 0.0 ? (force - hand.force) / travel : 0.0;
  outside_ = inside_ = Trial();
  same_side_ = -1;
  was_outside_ = true;
  stride_ = std::clamp((std::abs(force) - hand.limit) / std::max(stiffness, kStiffness), kLeastStride, kLargestStride);
  const double excess = excessOf(std::max(-1.0, sign_ * hand.force / hand.limit));
  is_assumed_ = sign_ * travel > kLeastInterval && excess < 0.0;
  if (is_assumed_)
    inside_ = {true, hand.before, excess};
}

/** Next position of the hand that slips. */
double GripSearch::next(double force, double position)
{
  const GrippingHand& hand = hands_[*slipping_];
  const double excess = excessOf(std::max(-1.0, sign_ * force / hand.limit));
  Trial& other = excess > 0.0 ? inside_ : outside_;
  (excess > 0.0 ? outside_ : inside_) = {true, position, excess};
  same_side_ = (excess > 0.0) == was_outside_ ? same_side_ + 1 : 0;
  was_outside_ = excess > 0.0;
  is_assumed_ = is_assumed_ && excess > 0.0;
  if (is_assumed_ && std::abs(inside_.position - position) <= kLeastInterval)
    is_assumed_ = inside_.known = false;
  if (!inside_.known)
  {
    position -= sign_ * stride_;
    stride_ *= 2.0;
    return std::clamp(position, hand.least, hand.most);
  }
  if (!outside_.known)
    return position;
  double share = outside_.excess / (outside_.excess - inside_.excess);
  if (same_side_ >= kMaxFalse)
    share = was_outside_ ? std::max(share, 1.0 - kClose) : std::min(share, kClose);
  other.excess *= 0.5;
  return outside_.position + share * (inside_.position - outside_.position);
}

/** Ends with the best trial. @return true where it is not the last one */
bool GripSearch::end(std::vector<double>& position)
{
  trials_ = kMaxTrials + 1;
  if (position == best_)
    return false;
  position = best_;
  return true;
}

bool GripSearch::improve(const std::vector<double>& force, std::vector<double>& position)
{
  if (trials_ > kMaxTrials)
    return false;
  if (trials_ == 0)
    wanted_ = position;
  double most = 0.0;
  for (std::size_t k = 0; k < hands_.size(); ++k)
    most = std::max(most, std::abs(force[k]) / hands_[k].limit);
  if (trials_ == 0 || most < least_ || (most <= 1.0 + kTolerance && least_ <= 1.0 + kTolerance))
  {
    best_ = position;
    least_ = most;
  }
  ++trials_;
  if (!choose(force, position))
    return false;
  const double next_position = next(force[*slipping_], position[*slipping_]);
  if (trials_ == kMaxTrials || next_position == position[*slipping_] ||
      (inside_.known && outside_.known && !is_assumed_ &&
       std::abs(inside_.position - outside_.position) <= kLeastInterval))
    return end(position);
  position[*slipping_] = next_position;
  return true;
}

}  // namespace endovascular_sim::drive
