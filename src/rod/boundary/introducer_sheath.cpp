#include "rod/boundary/introducer_sheath.h"

#include <algorithm>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kStiffness = 4e7;       // N/m², of the tube's wall per length of wire
constexpr double kMouthLength = 2.5e-3;  // m, length of wire that the contact at the rim represents

/** Second derivative of ½(r − c)² by the lateral offset: the normal turns with it. */
Eigen::Matrix3d curvatureOf(const Eigen::Vector3d& outward, const Eigen::Vector3d& axis, double tilt)
{
  const Eigen::Matrix3d radial = outward * outward.transpose();
  return radial + tilt * (Eigen::Matrix3d::Identity() - axis * axis.transpose() - radial);
}

}  // namespace

IntroducerSheath::IntroducerSheath(const Boundary& boundary)
  : origin_(boundary.origin), direction_(boundary.direction), clearance_(boundary.sheath_clearance)
{
}

bool IntroducerSheath::evaluateNode(const Eigen::Vector3d& position, double cell, GuidedEdge& node) const
{
  const double x = direction_.dot(position - origin_);
  const Eigen::Vector3d lateral = position - origin_ - x * direction_;
  const double distance = lateral.norm();
  if (x >= 0.0 || distance <= clearance_)
    return false;
  const double depth = distance - clearance_;
  const Eigen::Vector3d outward = lateral / distance;
  const double root = std::min(1.0, -x / kMouthLength);                  // of the share of the stiffness
  const double slope = root < 1.0 ? -2.0 / (root * kMouthLength) : 0.0;  // logarithmic derivative of the share by x
  const double stiffness = kStiffness * cell * root * root;
  node.reset();
  node.energy = 0.5 * stiffness * depth * depth;
  node.gradient[0] = stiffness * depth * (outward + (0.5 * slope * depth) * direction_);
  const Eigen::Vector3d coupling = slope * depth * outward;
  node.first =
      stiffness * (curvatureOf(outward, direction_, depth / distance) + coupling * direction_.transpose() +
                   direction_ * coupling.transpose() + coupling.squaredNorm() * direction_ * direction_.transpose());
  return true;
}

bool IntroducerSheath::evaluateRim(const Eigen::Vector3d& first, const Eigen::Vector3d& second, GuidedEdge& edge) const
{
  const double x0 = direction_.dot(first - origin_);
  const double x1 = direction_.dot(second - origin_);
  if (x0 >= 0.0 || x1 < 0.0)
    return false;
  const double t = -x0 / (x1 - x0);
  const std::array<double, 2> weight = {1.0 - t, t};
  const Eigen::Vector3d lateral = weight[0] * first + weight[1] * second - origin_;  // in the plane of the mouth
  const double distance = lateral.norm();
  if (distance <= clearance_)
    return false;
  const double depth = distance - clearance_;
  const Eigen::Vector3d outward = lateral / distance;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - direction_ * direction_.transpose();
  // A motion of the wire moves the point in the plane of the mouth: across it, and by the wire's slope along it.
  const Eigen::Matrix3d motion = across - (across * (second - first) / (x1 - x0)) * direction_.transpose();
  const double stiffness = kStiffness * kMouthLength;
  const Eigen::Vector3d force = stiffness * depth * (motion.transpose() * outward);
  const Eigen::Matrix3d hessian =
      stiffness * (motion.transpose() * curvatureOf(outward, direction_, depth / distance) * motion);
  edge.energy = 0.5 * stiffness * depth * depth;
  edge.gradient = {weight[0] * force, weight[1] * force};
  edge.first = weight[0] * weight[0] * hessian;
  edge.across = weight[0] * weight[1] * hessian;
  edge.second = weight[1] * weight[1] * hessian;
  return true;
}

}  // namespace endovascular_sim::rod
