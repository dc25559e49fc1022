#include "segmentation/lumen/edge_model.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::segmentation
{

double scaledBesselI0(double x)
{
  if (x < 3.75)
  {
    const double t = x * x / (3.75 * 3.75);
    return std::exp(-x) *
           (1.0 +
            t * (3.5156229 + t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813))))));
  }
  const double t = 3.75 / x;
  return (0.39894228 +
          t * (0.01328592 +
               t * (0.00225319 +
                    t * (-0.00157565 +
                         t * (0.00916281 +
                              t * (-0.02057706 + t * (0.02635537 + t * (-0.01647633 + t * 0.00392377)))))))) /
         std::sqrt(x);
}

double EdgeModel::discAtEdge(double radius) const
{
  const double square = radius * radius / (spread_ * spread_);
  return 0.5 * (1.0 - scaledBesselI0(square));
}

double EdgeModel::discInMiddle(double radius) const
{
  return -std::expm1(-0.5 * radius * radius / (spread_ * spread_));
}

double EdgeModel::radiusOfMiddle(double part) const
{
  return spread_ * std::sqrt(-2.0 * std::log1p(-part));
}

double EdgeModel::beyondWall(double radius) const
{
  if (wall_ <= 0.0)
    return 0.0;
  const double r = std::max(radius, spread_);
  return std::min(1.0, std::sqrt((r + wall_) / r) * 0.5 * std::erfc(wall_ / spread_ / std::sqrt(2.0)));
}

double EdgeModel::beyondGap(double gap) const
{
  return 0.5 * std::erfc(gap / spread_ / std::sqrt(2.0));
}

double EdgeModel::edgeValue(double radius, double lumen, double wall, double beyond) const
{
  return wall + (lumen - wall) * discAtEdge(radius) + (beyond - wall) * beyondWall(radius);
}

}  // namespace endovascular_sim::segmentation
