#include "contact/narrow_phase/smooth_edge_walk.h"

#include <cmath>

namespace endovascular_sim::contact
{
namespace
{

constexpr int kMostTrials = 12;
constexpr double kFoundSlope = 1e-6;  // sine of the angle between edge and wall at a minimum

}  // namespace

SmoothEdgeWalk::Place SmoothEdgeWalk::placeOf(double parameter, const SmoothFoot& foot) const
{
  return {parameter, foot, foot.normal.dot(along_) - taper_, foot.height - parameter * taper_};
}

SmoothEdgeWalk::Place SmoothEdgeWalk::placeFrom(double parameter, const SmoothFoot& near) const
{
  return placeOf(parameter, search_.walk(begin_ + parameter * along_, near));
}

SmoothEdgeWalk::Place SmoothEdgeWalk::minimumBetween(Place low, Place high) const
{
  double slope_low = low.slope;
  double slope_high = high.slope;
  Place lowest = low.gap < high.gap ? low : high;
  SmoothFoot foot = low.foot;
  for (int trial = 0; trial < kMostTrials; ++trial)
  {
    const double t = (low.parameter * slope_high - high.parameter * slope_low) / (slope_high - slope_low);
    const Place place = placeFrom(t, foot);
    foot = place.foot;
    if (place.gap < lowest.gap)
      lowest = place;
    if (std::abs(place.slope) < kFoundSlope * length_)
      break;
    if (place.slope < 0.0)
    {
      low = place;
      slope_low = place.slope;
      slope_high *= 0.5;
    }
    else
    {
      high = place;
      slope_high = place.slope;
      slope_low *= 0.5;
    }
  }
  return lowest;
}

std::optional<SmoothEdgeWalk::Place> SmoothEdgeWalk::minimumFrom(double parameter, int triangle) const
{
  const Place start = placeOf(parameter, search_.walk(begin_ + parameter * along_, triangle));
  if (std::abs(start.slope) < kFoundSlope * length_)
    return start;
  const Place end = placeFrom(start.slope < 0.0 ? 1.0 : 0.0, start.foot);
  if (start.slope < 0.0 && end.slope > 0.0)
    return minimumBetween(start, end);
  if (start.slope > 0.0 && end.slope < 0.0)
    return minimumBetween(end, start);
  return end.gap > start.gap ? std::optional<Place>(start) : std::nullopt;
}

}  // namespace endovascular_sim::contact
