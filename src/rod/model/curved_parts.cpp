#include "rod/model/curved_parts.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

/** Integral of a node's hat function over a stretch of arc length [m]. */
double hatIntegral(const std::vector<double>& position, int node, double begin, double end)
{
  double sum = 0.0;
  const int last = static_cast<int>(position.size()) - 1;
  for (const int edge : {node - 1, node})
  {
    if (edge < 0 || edge >= last)
      continue;
    const double from = std::max(begin, position[edge]);
    const double to = std::min(end, position[edge + 1]);
    if (to > from)
      sum += (to - from) * hatOf(position, node, 0.5 * (from + to));
  }
  return sum;
}

const CurvedPart* partAt(const std::vector<CurvedPart>& parts, double arc_length)
{
  for (const CurvedPart& part : parts)
    if (arc_length >= part.begin && arc_length < part.end)
      return &part;
  return nullptr;
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
  if (arc_length <= position[node])
    return node == 0 ? (arc_length < position[0] ? 0.0 : 1.0)
                     : std::max(0.0, (arc_length - position[node - 1]) / (position[node] - position[node - 1]));
  return node == last ? 0.0
                      : std::max(0.0, (position[node + 1] - arc_length) / (position[node + 1] - position[node]));
}

Eigen::Vector2d restAngle(const std::vector<CurvedPart>& parts, const std::vector<double>& position, int node,
                          double from)
{
  Eigen::Vector2d angle = Eigen::Vector2d::Zero();
  for (const CurvedPart& part : parts)
    angle += hatIntegral(position, node, std::max(from, part.begin), part.end) * part.curvature;
  return angle;
}

double hatBeyond(const std::vector<double>& position, int node, double from)
{
  return hatIntegral(position, node, from, position.back());
}

Eigen::Vector2d restCurvatureAt(const std::vector<CurvedPart>& parts, double arc_length)
{
  const CurvedPart* part = partAt(parts, arc_length);
  return part != nullptr ? part->curvature : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

double straightEnergy(const std::vector<CurvedPart>& parts, double up_to)
{
  double energy = 0.0;
  for (const CurvedPart& part : parts)
    energy += 0.5 * part.bending_stiffness * part.curvature.squaredNorm() *
              std::max(0.0, std::min(up_to, part.end) - part.begin);
  return energy;
}

double straightEnergyPerLength(const std::vector<CurvedPart>& parts, double arc_length)
{
  const CurvedPart* part = partAt(parts, arc_length);
  return part != nullptr ? 0.5 * part->bending_stiffness * part->curvature.squaredNorm() : 0.0;
}

}  // namespace endovascular_sim::rod
