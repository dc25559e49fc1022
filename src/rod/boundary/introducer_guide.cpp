#include "rod/boundary/introducer_guide.h"

#include <algorithm>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLongestDecay = 0.25;  // of the guide's length: a deflection at the mouth has decayed at its other end

// Gauss's rule with three points, exact up to degree five: that of the potential on a straight edge.
constexpr std::array<double, 3> kPoint = {0.11270166537925831, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> kWeight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

}  // namespace

void GuidedEdge::reset()
{
  energy = 0.0;
  gradient[0].setZero();
  gradient[1].setZero();
  first.setZero();
  across.setZero();
  second.setZero();
}

IntroducerGuide::IntroducerGuide(const Boundary& boundary)
  : origin_(boundary.origin),
    direction_(boundary.direction),
    decay_(boundary.introducer ? std::min(boundary.guide_decay, kLongestDecay * boundary.guide_length) : 0.0),
    reach_(kReach * decay_)
{
}

/** Potential of a point of the wire, with its derivatives by the point. */
struct IntroducerGuide::Point
{
  double energy;            // [J]
  Eigen::Vector3d force;    // [N]
  Eigen::Matrix3d hessian;  // [N/m]
};

/** @param depth of the point, over λ
 *  @param scale weight of the point over λ⁴ */
inline IntroducerGuide::Point IntroducerGuide::pointAt(double depth, const Eigen::Vector3d& lateral, double scale,
                                                       GuideStiffness form) const
{
  const double along = form == GuideStiffness::kExact ? 1.0 / 3.0 : 1.0;  // of the square of the slope
  const double axial_share = form == GuideStiffness::kLateral ? 0.0 : 1.0;
  const double stiffness = scale * depth * depth * depth;
  // Of the stiffness by X, relative to it; the second one: slope² 2/3.
  const double slope = -3.0 * axial_share * (1.0 / decay_) / depth;
  const double squared = lateral.squaredNorm();
  Point point;
  point.energy = 0.5 * stiffness * squared;
  point.force = stiffness * (lateral + (0.5 * slope * squared) * direction_);
  const Eigen::Vector3d coupling = slope * lateral;
  point.hessian = coupling * direction_.transpose() + direction_ * coupling.transpose() +
                  (along * slope * slope * squared - 1.0) * direction_ * direction_.transpose();
  point.hessian.diagonal().array() += 1.0;
  point.hessian *= stiffness;
  return point;
}

void IntroducerGuide::evaluate(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double weight,
                               GuidedEdge& edge, GuideStiffness form) const
{
  edge.reset();
  const double x0 = axial(first);
  const double x1 = axial(second);
  const Eigen::Vector3d y0 = first - origin_ - x0 * direction_;
  const Eigen::Vector3d y1 = second - origin_ - x1 * direction_;
  const double inside = x1 > reach_ ? (reach_ - x0) / (x1 - x0) : 1.0;
  const double inverse = 1.0 / decay_;
  const double scale = weight * inside * inverse * inverse * inverse * inverse;
  for (std::size_t q = 0; q < kPoint.size(); ++q)
  {
    const double t = inside * kPoint[q];
    const Point point =
        pointAt((reach_ - x0 - t * (x1 - x0)) * inverse, (1.0 - t) * y0 + t * y1, scale * kWeight[q], form);
    edge.energy += point.energy;
    edge.gradient[0] += (1.0 - t) * point.force;
    edge.gradient[1] += t * point.force;
    edge.first += (1.0 - t) * (1.0 - t) * point.hessian;
    edge.across += t * (1.0 - t) * point.hessian;
    edge.second += t * t * point.hessian;
  }
}

void IntroducerGuide::evaluate(const Eigen::Vector3d& first, const Eigen::Vector3d& second, const EdgeBow& bow,
                               double weight, CurvedEdge& edge) const
{
  edge.reset();
  edge.by_bow = EdgeBow();
  edge.first_even.setZero();
  edge.second_even.setZero();
  const double x0 = axial(first);
  const double x1 = axial(second);
  const double inside = x1 > reach_ ? (reach_ - x0) / (x1 - x0) : 1.0;
  const double scale = weight * inside / (decay_ * decay_ * decay_ * decay_);
  double by_inside = 0.0;
  for (std::size_t q = 0; q < kPoint.size(); ++q)
  {
    const double t = inside * kPoint[q];
    const double even = 4.0 * t * (1.0 - t);
    const double odd = 0.25 * even * (1.0 - 2.0 * t);
    const Eigen::Vector3d from = (1.0 - t) * first + t * second + even * bow.even + odd * bow.odd - origin_;
    const double x = direction_.dot(from);
    if (x >= reach_)
      continue;
    const Point point =
        pointAt((reach_ - x) / decay_, from - x * direction_, scale * kWeight[q], GuideStiffness::kExact);
    edge.energy += point.energy;
    edge.gradient[0] += (1.0 - t) * point.force;
    edge.gradient[1] += t * point.force;
    edge.by_bow.even += even * point.force;
    edge.by_bow.odd += odd * point.force;
    edge.first += (1.0 - t) * (1.0 - t) * point.hessian;
    edge.across += t * (1.0 - t) * point.hessian;
    edge.second += t * t * point.hessian;
    edge.first_even += (1.0 - t) * even * point.hessian;
    edge.second_even += t * even * point.hessian;
    by_inside += point.energy / inside + kPoint[q] * point.force.dot(second - first + (4.0 - 8.0 * t) * bow.even +
                                                                     (1.0 - 6.0 * t + 6.0 * t * t) * bow.odd);
  }
  if (inside == 1.0)
    return;
  // On a straight edge this vanishes: the rule is exact there, and the potential is zero at its end.
  edge.gradient[0] += (by_inside * (inside - 1.0) / (x1 - x0)) * direction_;
  edge.gradient[1] -= (by_inside * inside / (x1 - x0)) * direction_;
}

double IntroducerGuide::density(const Eigen::Vector3d& position) const
{
  const double x = axial(position);
  if (decay_ == 0.0 || x >= reach_)
    return 0.0;
  const double depth = (reach_ - x) / decay_;
  const double squared = (position - origin_ - x * direction_).squaredNorm();
  return 0.5 * depth * depth * depth / (decay_ * decay_ * decay_ * decay_) * squared;
}

}  // namespace endovascular_sim::rod
