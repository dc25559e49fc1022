#include "simulation/degraded/stale_contact_pacer.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kUsable = 0.9;                    // of the cover: the wire also moves by itself
constexpr double kLever = 2e-3;                    // m of a tip's side of which a turning hand makes travel
constexpr double kCreep = 2e-3;                    // m/s, well above the speed below which friction fades
constexpr double kCreepTime = 15e-3;               // s for which the creep must last
constexpr double kLeastBraking = 0.1;              // of the cover
constexpr double kSpeedTime = 10e-3;               // s over which the hand's speed is averaged
constexpr double kRecovery = 100.0;                // 1/s
constexpr double kReleaseTime = 6.75 / kRecovery;  // s
constexpr double kSlowRelease = 5e-3;              // m/s
constexpr double kFastRelease = 0.2;               // of the hand's speed
constexpr double kNothing = 1e-9;                  // m or rad: then all is made up for
constexpr double kFullPace = 1e-6;                 // from 1

double travelOf(double insertion, double rotation)
{
  return std::abs(insertion) + kLever * std::abs(rotation);
}

}  // namespace

double StaleContactPacer::Channel::follow(double wanted, double pace, bool blind, double most, double dt)
{
  const double news = wanted - missed;
  const double target = blind ? 0.0 : std::max(-most, std::min(most, missed / kReleaseTime));
  release_rate += dt * (kRecovery * kRecovery * (target - release) - 2.0 * kRecovery * release_rate);
  release += dt * release_rate;
  const double motion = pace * (news + dt * release);
  missed = wanted - motion;
  return motion;
}

/** Moves the pace towards @p target with |p''| ≤ @p jerk, as fast as it can without overshoot. */
void StaleContactPacer::approach(double target, double jerk)
{
  const double side = target >= pace_ ? 1.0 : -1.0;
  const double left = side * (target - pace_);
  double rate = side * pace_rate_;
  const double faster = rate + dt_ * jerk;
  if (rate < 0.0 || left - dt_ * faster >= faster * (faster / jerk - dt_) / 2.0)
    rate = faster;
  else if (rate > 0.0)
    rate -= dt_ * rate * rate / (2.0 * left + dt_ * rate);  // comes to rest right at the target
  if (left - dt_ * rate < dt_ * dt_ * jerk && rate < 2.0 * dt_ * jerk)
  {
    pace_ = target;
    pace_rate_ = 0.0;
    return;
  }
  pace_rate_ = side * rate;
  pace_ = std::max(0.0, pace_ + dt_ * pace_rate_);
}

/** To the creep, with as little jerk as the rest of the cover allows. */
void StaleContactPacer::brake()
{
  const double creep = speed_ > kCreep ? kCreep / speed_ : 1.0;
  const double room = std::max(kLeastBraking * cover_, reach() - last_ - kCreepTime * kCreep);
  jerk_ = std::max(kRecovery * kRecovery, speed_ * speed_ / (room * room));
  if (pace_ > creep || pace_rate_ != 0.0)
    approach(std::min(creep, pace_), jerk_);
}

HandCommand StaleContactPacer::follow(const HandCommand& wanted, bool blind)
{
  HandCommand motion = wanted;
  if (blind || !isAtRest())
  {
    if (blind)
      brake();
    else
      approach(1.0, pace_rate_ < 0.0 ? jerk_ : kRecovery * kRecovery);
    const double most = kSlowRelease + kFastRelease * speed_;
    motion.insertion = insertion_.follow(wanted.insertion, pace_, blind, most, dt_);
    motion.rotation = rotation_.follow(wanted.rotation, pace_, blind, most / kLever, dt_);
  }
  double travel = travelOf(motion.insertion, motion.rotation);
  if (blind)
  {
    travel_ += last_;
    const double left = std::max(0.0, reach() - travel_);
    if (travel > left)
    {
      miss({(1.0 - left / travel) * motion.insertion, (1.0 - left / travel) * motion.rotation});
      motion.insertion *= left / travel;
      motion.rotation *= left / travel;
      travel = left;
    }
  }
  else
  {
    travel_ = 0.0;
    speed_ += std::min(1.0, dt_ / kSpeedTime) * (travel / dt_ - speed_);
    for (Channel* channel : {&insertion_, &rotation_})
      if (pace_ == 1.0 && std::abs(channel->missed) < kNothing)
        *channel = Channel();
  }
  last_ = travel;
  return motion;
}

double StaleContactPacer::reach() const
{
  return kUsable * cover_;
}

void StaleContactPacer::miss(const HandCommand& motion)
{
  insertion_.missed += motion.insertion;
  rotation_.missed += motion.rotation;
}

void StaleContactPacer::Channel::archive(Archive& archive)
{
  archive(missed, release, release_rate);
}

void StaleContactPacer::archive(Archive& archive)
{
  archive(insertion_, rotation_, pace_, pace_rate_, jerk_, speed_, last_, travel_);
}

}  // namespace endovascular_sim::simulation
