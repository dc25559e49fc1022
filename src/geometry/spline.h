#pragma once

#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** Natural cubic spline through points, with the chord lengths as parameter: C², no overshoot between even points. */
class Spline3
{
public:
  /** @pre at least two points, neighbours distinct */
  explicit Spline3(const std::vector<Eigen::Vector3d>& points);

  /** Parameter of each control point [m]; from 0 up. */
  const std::vector<double>& knots() const { return knots_; }
  Eigen::Vector3d position(double u) const;
  Eigen::Vector3d derivative(double u) const;

private:
  std::size_t interval(double u) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> second_;  ///< second derivatives at the knots
  std::vector<double> knots_;
};

/** Monotone piecewise cubic through values (F. N. Fritsch, J. Butland, 1984): no over- or undershoot; constant outside.
 */
class MonotoneCubic
{
public:
  /** @pre positions increase strictly, at least one */
  MonotoneCubic(std::vector<double> positions, std::vector<double> values);
  double operator()(double x) const;

private:
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> slope_;
};

}  // namespace endovascular_sim::geometry
