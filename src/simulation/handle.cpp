#include "simulation/handle.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kGripTime = 10e-3;     // s in which the grip follows the force
constexpr double kSlipBand = 0.1;       // range of the force in which the grip fades, relative to the limit
constexpr double kFreeBand = 0.5;       // excess of the force without any grip, relative to the limit
constexpr double kStalledSpeed = 0.05;  // least share of the speed with which a stopped chuck pushes

/** Grip of the hand, 1 firm to 0 slipping, after a time @p dt [s] in which the wire resisted the wanted motion. The
 * grip follows the force with a delay: without it, grip and inertia of the wire would oscillate. Far beyond the limit
 * the grip vanishes at once, since a fast hand would push by millimetres during the delay. */
double nextGrip(double grip, double wanted, double resistance, double limit, double dt)
{
  const double against = wanted > 0.0 ? resistance : -resistance;
  const double target = std::max(0.0, std::min(1.0, (limit - against) / (kSlipBand * limit)));
  const double firm = 1.0 - (against - limit) / (kFreeBand * limit);
  return std::max(0.0, std::min(grip + std::min(1.0, dt / kGripTime) * (target - grip), firm));
}

}  // namespace

drive::HandIncrement Handle::wanted(const HandState& now, const drive::HandCommand& command, const HandleRange* range,
                                    bool stale, double dt)
{
  drive::HandIncrement rest{0.0, command.rotation - slipped_.rotation - now.rotation};
  if (range != nullptr)
  {
    // Limited after the slip, or a wire that has slipped in the fingers could not leave the introducer.
    rest.insertion = std::max(range->commanded, command.insertion - slipped_.insertion) - now.insertion;
    if (!slips_)  // waits at a stop
      rest.insertion =
          std::clamp(rest.insertion, range->least - now.insertion, std::max(range->least, range->most) - now.insertion);
  }
  drive::HandIncrement motion = pacer_.follow(rest, stale);
  // A chuck that is stopped by the force pushes on slowly; fast attempts would only cost sub-steps.
  const double most = speed_ * dt * (!slips_ ? std::max(kStalledSpeed, grip_) : 1.0);
  const double most_turn = turning_speed_ * dt * (!slips_ ? std::max(kStalledSpeed, turning_grip_) : 1.0);
  motion.insertion = std::clamp(motion.insertion, -most, most);
  motion.rotation = std::clamp(motion.rotation, -most_turn, most_turn);
  return motion;
}

drive::HandIncrement Handle::allowed(const HandState& now, const drive::HandIncrement& wanted, const HandleRange& range,
                                     double dt)
{
  grip_ = nextGrip(grip_, wanted.insertion, now.force, force_limit_, dt);
  const double reached = std::max(range.least, std::min(range.most, now.insertion + grip_ * wanted.insertion));
  turning_grip_ = nextGrip(turning_grip_, wanted.rotation, now.torque, torque_limit_, dt);
  const drive::HandIncrement motion = {reached - now.insertion, turning_grip_ * wanted.rotation};
  if (slips_)
  {
    slipped_.insertion += wanted.insertion - motion.insertion;
    slipped_.rotation += wanted.rotation - motion.rotation;
  }
  return motion;
}

void Handle::noteSlip(double before, double wanted, double reached)
{
  if (wanted == reached)
    return;
  if (wanted != before)
    grip_ = std::min(grip_, std::clamp((reached - before) / (wanted - before), 0.0, 1.0));
  if (slips_)
    slipped_.insertion += wanted - reached;
}

void Handle::archive(Archive& archive)
{
  archive(pacer_, slipped_.insertion, slipped_.rotation, grip_, turning_grip_);
  if (archive.reading())
    requireFinite(slipped_.insertion, slipped_.rotation, grip_, turning_grip_);
}

}  // namespace endovascular_sim::simulation
