#include <algorithm>
#include <cmath>

#include "procedure/operator.h"

// Steering of the scripted operator: rotation of a bent tip near junctions.

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kApproach = 0.02;       // distance before a junction from which the tip is turned [m]
constexpr double kPassed = 0.005;        // distance behind a junction up to which it is turned [m]
constexpr double kLookAhead = 0.006;     // distance of the target ahead of the tip, besides the length of the bend [m]
constexpr double kTolerance = 0.25;      // deviation that needs no rotation [rad]
constexpr double kGain = 2.0;            // rotation speed per deviation [1/s]
constexpr double kFastestTurn = 2.0;     // [rad/s]
constexpr double kHoldDeviation = 1.0;   // deviation at which the operator stops advancing [rad]
constexpr double kSlowestAdvance = 0.3;  // share of the speed that remains, so that a jammed tip comes free

}  // namespace

/** Turns the bend of the tip along the path to the goal if a junction is near, and slows down until it points there. */
void Operator::steer(const InstrumentView& view)
{
  if (!route_ || view.covered || view.bend.length <= 0.0)
    return;
  const double arc = route_->line().nearest(view.tip).arc;
  const double ahead = route_->toJunction(arc);
  if (ahead > kApproach || ahead < -kPassed)
    return;
  const Eigen::Vector3d target = route_->line().at(arc + view.bend.length + kLookAhead);
  const double deviation = turnTowards(view.bend, view.tip, target);
  if (std::abs(deviation) < kTolerance)
    return;
  Hand& hand = hands_[static_cast<std::size_t>(active_)];
  const double fastest = std::min(kFastestTurn, hand_.max_turn);
  hand.target_turn_speed = std::clamp(kGain * deviation, -fastest, fastest);
  const double share = 1.0 - (1.0 - kSlowestAdvance) * std::min(1.0, std::abs(deviation) / kHoldDeviation);
  hand.target_speed *= share;
}

}  // namespace endovascular_sim::procedure
