#include "procedure/tip_steering.h"

#include <algorithm>
#include <cmath>

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

std::optional<TipSteering> steeringOf(const Route& route, const InstrumentView& view, double max_turn)
{
  if (view.covered || view.bend.length <= 0.0)
    return std::nullopt;
  const double arc = route.line().nearest(view.tip).arc;
  const double ahead = route.toJunction(arc);
  if (ahead > kApproach || ahead < -kPassed)
    return std::nullopt;
  const Eigen::Vector3d target = route.line().at(arc + view.bend.length + kLookAhead);
  const double deviation = turnTowards(view.bend, view.tip, target);
  if (std::abs(deviation) < kTolerance)
    return std::nullopt;
  const double fastest = std::min(kFastestTurn, max_turn);
  return TipSteering{std::clamp(kGain * deviation, -fastest, fastest),
                     1.0 - (1.0 - kSlowestAdvance) * std::min(1.0, std::abs(deviation) / kHoldDeviation)};
}

}  // namespace endovascular_sim::procedure
