#include "simulation/degraded/stale_contact_pacer.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kUsable = 0.9;                    ///< usable share of the cover: the wire also moves by itself [1]
constexpr double kLever = 2e-3;                    ///< lateral reach of a bent tip: rotation to travel [m]
constexpr double kCreep = 2e-3;                    ///< creep speed, well above the regularisation of friction [m/s]
constexpr double kCreepTime = 15e-3;               ///< duration that the creep must last [s]
constexpr double kLeastBraking = 0.1;              ///< smallest braking travel, relative to the cover [1]
constexpr double kSpeedTime = 10e-3;               ///< time constant of the speed's average [s]
constexpr double kRecovery = 100.0;                ///< frequency ω of the recovery [1/s]
constexpr double kReleaseTime = 6.75 / kRecovery;  ///< time constant τ of the release [s]
constexpr double kSlowRelease = 5e-3;              ///< constant part of the release speed's limit [m/s]
constexpr double kFastRelease = 0.2;               ///< part of the limit relative to the earlier speed [1]
constexpr double kNothing = 1e-9;                  ///< missed motion that counts as none [m or rad]

double travelOf(double insertion, double rotation)
{
  return std::abs(insertion) + kLever * std::abs(rotation);
}

}  // namespace

double StaleContactPacer::Channel::follow(double wanted, double pace, bool stale, double most, double dt)
{
  const double commanded = wanted - missed;
  const double target = stale ? 0.0 : std::max(-most, std::min(most, missed / kReleaseTime));
  release_rate += dt * (kRecovery * kRecovery * (target - release) - 2.0 * kRecovery * release_rate);
  release += dt * release_rate;
  const double motion = pace * (commanded + dt * release);
  missed = wanted - motion;
  return motion;
}

/** Moves the pace towards @p target in the shortest time without overshoot, with |p''| ≤ @p jerk. */
void StaleContactPacer::approach(double target, double jerk)
{
  const double sign = target >= pace_ ? 1.0 : -1.0;
  const double distance = sign * (target - pace_);
  double rate = sign * pace_rate_;
  const double faster_rate = rate + dt_ * jerk;
  if (rate < 0.0 || distance - dt_ * faster_rate >= faster_rate * (faster_rate / jerk - dt_) / 2.0)
    rate = faster_rate;
  else if (rate > 0.0)
    rate -= dt_ * rate * rate / (2.0 * distance + dt_ * rate);  // stops exactly at the target
  if (distance - dt_ * rate < dt_ * dt_ * jerk && rate < 2.0 * dt_ * jerk)
  {
    pace_ = target;
    pace_rate_ = 0.0;
    return;
  }
  pace_rate_ = sign * rate;
  pace_ = std::max(0.0, pace_ + dt_ * pace_rate_);
}

/** Brakes to the creep with the smallest jerk that the remaining cover permits. */
void StaleContactPacer::brake()
{
  const double creep = speed_ > kCreep ? kCreep / speed_ : 1.0;
  const double distance = std::max(kLeastBraking * cover_, reach() - last_travel_ - kCreepTime * kCreep);
  jerk_ = std::max(kRecovery * kRecovery, speed_ * speed_ / (distance * distance));
  if (pace_ > creep || pace_rate_ != 0.0)
    approach(std::min(creep, pace_), jerk_);
}

drive::HandIncrement StaleContactPacer::follow(const drive::HandIncrement& wanted, bool stale)
{
  drive::HandIncrement motion = wanted;
  if (stale || !isAtRest())
  {
    if (stale)
      brake();
    else
      approach(1.0, pace_rate_ < 0.0 ? jerk_ : kRecovery * kRecovery);
    const double most = kSlowRelease + kFastRelease * speed_;
    motion.insertion = insertion_.follow(wanted.insertion, pace_, stale, most, dt_);
    motion.rotation = rotation_.follow(wanted.rotation, pace_, stale, most / kLever, dt_);
  }
  double travel = travelOf(motion.insertion, motion.rotation);
  if (stale)
  {
    travel_ += last_travel_;
    const double remaining = std::max(0.0, reach() - travel_);
    if (travel > remaining)
    {
      miss({(1.0 - remaining / travel) * motion.insertion, (1.0 - remaining / travel) * motion.rotation});
      motion.insertion *= remaining / travel;
      motion.rotation *= remaining / travel;
      travel = remaining;
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
  last_travel_ = travel;
  return motion;
}

double StaleContactPacer::reach() const
{
  return kUsable * cover_;
}

void StaleContactPacer::miss(const drive::HandIncrement& motion)
{
  insertion_.missed += motion.insertion;
  rotation_.missed += motion.rotation;
}

void StaleContactPacer::Channel::archive(Archive& archive)
{
  archive(missed, release, release_rate);
  if (archive.reading())
    requireFinite(missed, release, release_rate);
}

void StaleContactPacer::archive(Archive& archive)
{
  archive(insertion_, rotation_, pace_, pace_rate_, jerk_, speed_, last_travel_, travel_);
  if (archive.reading())
    requireFinite(pace_, pace_rate_, jerk_, speed_, last_travel_, travel_);
}

}  // namespace endovascular_sim::simulation
