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

void IntroducerGuide::evaluate(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double weight,
                               GuidedEdge& edge, GuideStiffness form) const
{
  const double along = form == GuideStiffness::kExact ? 1.0 / 3.0 : 1.0;  // of the square of the slope
  const double axial_share = form == GuideStiffness::kLateral ? 0.0 : 1.0;
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
    const double depth = (reach_ - x0 - t * (x1 - x0)) * inverse;
    const double stiffness = scale * kWeight[q] * depth * depth * depth;
    // Of the stiffness by X, relative to it; the second one: slope² 2/3.
    const double slope = -3.0 * axial_share * inverse / depth;
    const Eigen::Vector3d y = (1.0 - t) * y0 + t * y1;
    const double squared = y.squaredNorm();
    edge.energy += 0.5 * stiffness * squared;
    const Eigen::Vector3d force = stiffness * (y + (0.5 * slope * squared) * direction_);
    edge.gradient[0] += (1.0 - t) * force;
    edge.gradient[1] += t * force;
    const Eigen::Vector3d coupling = slope * y;
    Eigen::Matrix3d hessian = coupling * direction_.transpose() + direction_ * coupling.transpose() +
                              (along * slope * slope * squared - 1.0) * direction_ * direction_.transpose();
    hessian.diagonal().array() += 1.0;
    hessian *= stiffness;
    edge.first += (1.0 - t) * (1.0 - t) * hessian;
    edge.across += t * (1.0 - t) * hessian;
    edge.second += t * t * hessian;
  }
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
