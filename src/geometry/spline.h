#pragma once

#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** Natural cubic spline through points, parametrised by cumulative chord length; C². */
class Spline3
{
public:
  /** @pre at least two points; consecutive points are distinct */
  explicit Spline3(const std::vector<Eigen::Vector3d>& points);

  /** Parameter of each control point [m]; the first is 0. */
  const std::vector<double>& knots() const { return knots_; }
  Eigen::Vector3d position(double u) const;
  Eigen::Vector3d derivative(double u) const;

private:
  std::size_t interval(double u) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> second_;  ///< second derivatives at the knots
  std::vector<double> knots_;
};

/** Monotone piecewise cubic interpolation, constant outside of its range. F. N. Fritsch, J. Butland, "A method for
 *  constructing local monotone piecewise cubic interpolants", 1984. */
class MonotoneCubic
{
public:
  /** @pre at least one position; positions increase strictly */
  MonotoneCubic(std::vector<double> positions, std::vector<double> values);
  double operator()(double x) const;

private:
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> slope_;
};

}  // namespace endovascular_sim::geometry
