#include "rod/model/curved_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

/** Integral of a function that is quadratic between the breaks, by Simpson's rule.
 *  @param breaks ascending */
template <std::size_t Count, typename Function>
double integral(double begin, double end, const std::array<double, Count>& breaks, Function function)
{
  double sum = 0.0;
  double from = begin;
  for (std::size_t k = 0; k <= Count; ++k)
  {
    const double to = k < Count ? std::clamp(breaks[k], from, std::max(from, end)) : end;
    if (to <= from)
      continue;
    sum += (to - from) / 6.0 * (function(from) + 4.0 * function(0.5 * (from + to)) + function(to));
    from = to;
  }
  return sum;
}

double middleOfFirst(const std::vector<double>& position)
{
  return 0.5 * (position[0] + position[1]);
}

/** Begin and end of the part of an edge on which the hat function of one of its nodes is not zero. */
double supportBegin(const std::vector<double>& position, int node, int edge)
{
  return edge == 0 && node == 1 ? middleOfFirst(position) : position[edge];
}

double supportEnd(const std::vector<double>& position, int node, int edge)
{
  return edge == 0 && node == 0 ? middleOfFirst(position) : position[edge + 1];
}

/** Integral of a node's hat function times the acting share over a stretch of arc length [m]. */
double hatIntegral(const std::vector<double>& position, int node, double begin, double end, const Mouth& mouth)
{
  double sum = 0.0;
  const int last = static_cast<int>(position.size()) - 1;
  for (const int edge : {node - 1, node})
  {
    if (edge < 0 || edge >= last)
      continue;
    sum += integral<2>(std::max({begin, supportBegin(position, node, edge), mouth.begin()}),
                       std::min(end, supportEnd(position, node, edge)), {mouth.begin(), mouth.end()},
                       [&](double at) { return hatOf(position, node, at) * mouth.share(at); });
  }
  return sum;
}

/** Integral of a node's hat function over a stretch of arc length [m]. */
double hatIntegral(const std::vector<double>& position, int node, double begin, double end)
{
  double sum = 0.0;
  const int last = static_cast<int>(position.size()) - 1;
  for (const int edge : {node - 1, node})
  {
    if (edge < 0 || edge >= last)
      continue;
    const double from = std::max(begin, supportBegin(position, node, edge));
    const double to = std::min(end, supportEnd(position, node, edge));
    if (to > from)
      sum += (to - from) * hatOf(position, node, 0.5 * (from + to));
  }
  return sum;
}

}  // namespace

Eigen::Vector2d integratedCurvature(const Eigen::Vector2d& angle)
{
  const double magnitude = angle.norm();
  return magnitude > 0.0 ? Eigen::Vector2d(angle * (2.0 * std::tan(0.5 * magnitude) / magnitude))
                         : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

Eigen::Vector2d turningAngle(const Eigen::Vector2d& curvature)
{
  const double magnitude = curvature.norm();
  return magnitude > 0.0 ? Eigen::Vector2d(curvature * (2.0 * std::atan(0.5 * magnitude) / magnitude))
                         : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

double hatOf(const std::vector<double>& position, int node, double arc_length)
{
  const int last = static_cast<int>(position.size()) - 1;
  if (node < 2 && arc_length >= position[0] && arc_length <= position[1])
    return (arc_length < middleOfFirst(position)) == (node == 0) ? 1.0 : 0.0;
  if (arc_length <= position[node])
    return node == 0 ? (arc_length < position[0] ? 0.0 : 1.0)
                     : std::max(0.0, (arc_length - position[node - 1]) / (position[node] - position[node - 1]));
  return node == last ? 0.0 : std::max(0.0, (position[node + 1] - arc_length) / (position[node + 1] - position[node]));
}

double Mouth::share(double at) const
{
  return std::clamp(0.5 + 0.5 * (at - arc_length) / half_width, 0.0, 1.0);
}

Eigen::Vector2d restAngle(const std::vector<CurvedPart>& parts, const std::vector<double>& position, int node)
{
  Eigen::Vector2d angle = Eigen::Vector2d::Zero();
  for (const CurvedPart& part : parts)
    angle += hatIntegral(position, node, part.begin, part.end) * part.curvature;
  return angle;
}

Eigen::Vector2d restAngle(const std::vector<CurvedPart>& parts, const std::vector<double>& position, int node,
                          const Mouth& mouth)
{
  Eigen::Vector2d angle = Eigen::Vector2d::Zero();
  for (const CurvedPart& part : parts)
    angle += hatIntegral(position, node, part.begin, part.end, mouth) * part.curvature;
  return angle;
}

Eigen::Vector2d restAngleSlope(const std::vector<CurvedPart>& parts, const std::vector<double>& position, int node,
                               const Mouth& mouth)
{
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (const CurvedPart& part : parts)
    slope += hatIntegral(position, node, std::max(part.begin, mouth.begin()), std::min(part.end, mouth.end())) /
             (2.0 * mouth.half_width) * part.curvature;
  return slope;
}

double hatBeyond(const std::vector<double>& position, int node, const Mouth& mouth)
{
  return hatIntegral(position, node, position.front(), position.back(), mouth);
}

double straightEnergy(const std::vector<CurvedPart>& parts, const Mouth& mouth)
{
  double energy = 0.0;
  for (const CurvedPart& part : parts)
    energy += 0.5 * part.bending_stiffness * part.curvature.squaredNorm() *
              integral<2>(part.begin, part.end, {mouth.begin(), mouth.end()},
                          [&mouth](double at) { return 1.0 - mouth.share(at); });
  return energy;
}

double straightEnergySlope(const std::vector<CurvedPart>& parts, const Mouth& mouth)
{
  double force = 0.0;
  for (const CurvedPart& part : parts)
    force += 0.5 * part.bending_stiffness * part.curvature.squaredNorm() *
             std::max(0.0, std::min(part.end, mouth.end()) - std::max(part.begin, mouth.begin())) /
             (2.0 * mouth.half_width);
  return force;
}

}  // namespace endovascular_sim::rod
