#include "geometry/polyline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace endovascular_sim::geometry
{

Polyline::Polyline(const std::vector<Eigen::Vector3d>& points, double tangent_reach)
{
  for (const Eigen::Vector3d& p : points)
  {
    const double length = points_.empty() ? 0.0 : (p - points_.back()).norm();
    if (!points_.empty() && !(length > 0.0))
      continue;
    arcs_.push_back(points_.empty() ? 0.0 : arcs_.back() + length);
    points_.push_back(p);
  }
  const std::size_t n = points_.size();
  for (std::size_t k = 0; k < n; ++k)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    if (k > 0)
      sum += (points_[k] - points_[k - 1]).normalized();
    if (k + 1 < n)
      sum += (points_[k + 1] - points_[k]).normalized();
    const double reach = std::min({tangent_reach, arcs_[k], arcs_.back() - arcs_[k]});
    if (reach > 0.0)
      sum = at(arcs_[k] + reach) - at(arcs_[k] - reach);
    tangents_.push_back(sum.normalized());
  }
}

std::size_t Polyline::segmentAt(double arc) const
{
  const auto beyond = std::upper_bound(arcs_.begin() + 1, arcs_.end() - 1, arc);
  return static_cast<std::size_t>(beyond - arcs_.begin()) - 1;
}

Eigen::Vector3d Polyline::at(double arc) const
{
  const std::size_t k = segmentAt(arc);
  const double t = (arc - arcs_[k]) / (arcs_[k + 1] - arcs_[k]);
  return points_[k] + std::clamp(t, 0.0, 1.0) * (points_[k + 1] - points_[k]);
}

Eigen::Vector3d Polyline::tangentAt(double arc) const
{
  const std::size_t k = segmentAt(arc);
  return (points_[k + 1] - points_[k]) / (arcs_[k + 1] - arcs_[k]);
}

double Polyline::interpolate(const std::vector<double>& values, double arc) const
{
  const std::size_t k = segmentAt(arc);
  const double t = (arc - arcs_[k]) / (arcs_[k + 1] - arcs_[k]);
  return values[k] + std::clamp(t, 0.0, 1.0) * (values[k + 1] - values[k]);
}

std::size_t Polyline::nearestSegment(const Eigen::Vector3d& p, double& best_t) const
{
  std::size_t best = 0;
  double best_squared = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < points_.size(); ++k)
  {
    const Eigen::Vector3d chord = points_[k + 1] - points_[k];
    const double t = std::clamp((p - points_[k]).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
    const double squared = (points_[k] + t * chord - p).squaredNorm();
    if (squared >= best_squared)
      continue;
    best_squared = squared;
    best = k;
    best_t = t;
  }
  return best;
}

Polyline::Foot Polyline::nearest(const Eigen::Vector3d& p) const
{
  double t = 0.0;
  const std::size_t k = nearestSegment(p, t);
  const Eigen::Vector3d chord = points_[k + 1] - points_[k];
  const Eigen::Vector3d foot = points_[k] + t * chord;
  return {arcs_[k] + t * (arcs_[k + 1] - arcs_[k]), foot, chord.normalized(), (foot - p).norm()};
}

Polyline::Foot Polyline::normalPlaneFoot(const Eigen::Vector3d& p) const
{
  double t = 0.0;
  return normalPlaneFoot(p, nearestSegment(p, t));
}

Polyline::Foot Polyline::normalPlaneFoot(const Eigen::Vector3d& p, std::size_t segment) const
{
  std::size_t k = segment;
  const auto beyond = [&](std::size_t point) { return (p - points_[point]).dot(tangents_[point]) > 0.0; };
  while (k > 0 && !beyond(k))
    --k;
  while (k + 2 < points_.size() && beyond(k + 1))
    ++k;
  // Root in [0, 1] of (p − P − t d)·(T + t ΔT) = 0 with chord d and tangents T to T + ΔT.
  const Eigen::Vector3d from = p - points_[k];
  const Eigen::Vector3d chord = points_[k + 1] - points_[k];
  const Eigen::Vector3d turn = tangents_[k + 1] - tangents_[k];
  const double constant = from.dot(tangents_[k]);
  const double linear = chord.dot(tangents_[k]) - from.dot(turn);
  const double root = linear * linear + 4.0 * chord.dot(turn) * constant;
  const double divisor = linear + std::sqrt(std::max(root, 0.0));
  const double t = divisor > 0.0 ? std::clamp(2.0 * constant / divisor, 0.0, 1.0) : 0.5;
  const Eigen::Vector3d foot = points_[k] + t * chord;
  const Eigen::Vector3d tangent = (tangents_[k] + t * turn).normalized();
  return {arcs_[k] + t * chord.norm(), foot, tangent, (foot - p).norm()};
}

Polyline Polyline::part(double begin, double end) const
{
  std::vector<Eigen::Vector3d> points{at(begin)};
  for (std::size_t k = 0; k < points_.size(); ++k)
    if (arcs_[k] > begin && arcs_[k] < end)
      points.push_back(points_[k]);
  points.push_back(at(end));
  return Polyline(points);
}

}  // namespace endovascular_sim::geometry
