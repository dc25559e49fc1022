#include "geometry/spline.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::geometry
{

Spline3::Spline3(const std::vector<Eigen::Vector3d>& points)
  : points_(points), second_(points.size(), Eigen::Vector3d::Zero()), knots_{0.0}
{
  const std::size_t n = points.size();
  for (std::size_t k = 1; k < n; ++k)
    knots_.push_back(knots_.back() + (points[k] - points[k - 1]).norm());
  // Tridiagonal system for the second derivatives (Thomas algorithm) with natural end conditions.
  std::vector<double> factor(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k)
  {
    const double before = knots_[k] - knots_[k - 1];
    const double after = knots_[k + 1] - knots_[k];
    const Eigen::Vector3d bend = 6.0 * ((points[k + 1] - points[k]) / after - (points[k] - points[k - 1]) / before);
    const double pivot = 2.0 * (before + after) - before * factor[k - 1];
    factor[k] = after / pivot;
    second_[k] = (bend - before * second_[k - 1]) / pivot;
  }
  for (std::size_t k = n - 1; k-- > 1;)
    second_[k] -= factor[k] * second_[k + 1];
}

std::size_t Spline3::interval(double u) const
{
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, u);
  return static_cast<std::size_t>(after - knots_.begin()) - 1;
}

Eigen::Vector3d Spline3::position(double u) const
{
  const std::size_t k = interval(u);
  const double h = knots_[k + 1] - knots_[k];
  const double a = (knots_[k + 1] - u) / h;
  const double b = 1.0 - a;
  return a * points_[k] + b * points_[k + 1] +
         h * h / 6.0 * ((a * a * a - a) * second_[k] + (b * b * b - b) * second_[k + 1]);
}

Eigen::Vector3d Spline3::derivative(double u) const
{
  const std::size_t k = interval(u);
  const double h = knots_[k + 1] - knots_[k];
  const double a = (knots_[k + 1] - u) / h;
  const double b = 1.0 - a;
  return (points_[k + 1] - points_[k]) / h +
         h / 6.0 * ((1.0 - 3.0 * a * a) * second_[k] + (3.0 * b * b - 1.0) * second_[k + 1]);
}

MonotoneCubic::MonotoneCubic(std::vector<double> positions, std::vector<double> values)
  : x_(std::move(positions)), y_(std::move(values)), slope_(x_.size(), 0.0)
{
  for (std::size_t k = 1; k + 1 < x_.size(); ++k)
  {
    const double before = x_[k] - x_[k - 1];
    const double after = x_[k + 1] - x_[k];
    const double rise_before = (y_[k] - y_[k - 1]) / before;
    const double rise_after = (y_[k + 1] - y_[k]) / after;
    if (rise_before * rise_after <= 0.0)
      continue;
    const double w1 = 2.0 * after + before;
    const double w2 = after + 2.0 * before;
    slope_[k] = (w1 + w2) / (w1 / rise_before + w2 / rise_after);
  }
}

double MonotoneCubic::operator()(double x) const
{
  if (x <= x_.front())
    return y_.front();
  if (x >= x_.back())
    return y_.back();
  const auto k = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin()) - 1;
  const double h = x_[k + 1] - x_[k];
  const double t = (x - x_[k]) / h;
  const double s = 1.0 - t;
  return (1.0 + 2.0 * t) * s * s * y_[k] + t * s * s * h * slope_[k] + (3.0 - 2.0 * t) * t * t * y_[k + 1] -
         t * t * s * h * slope_[k + 1];
}

}  // namespace endovascular_sim::geometry
