#include "motion/map/map_bounds.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "motion/map/field_terms.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

/** Eigenvalues of a symmetric matrix, ascending. */
Vector3d eigenvalues(const Matrix3d& symmetric)
{
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(symmetric, Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

/** Bound of the second derivative along any unit vector: its component i is at most the spectral norm of matrix i. */
double directionalBound(const SecondDerivatives& second)
{
  double sum = 0.0;
  for (const Matrix3d& component : second)
    sum += eigenvalues(component).cwiseAbs2().maxCoeff();
  return std::sqrt(sum);
}

MapBounds boundsAt(const MotionMap& map, const Vector3d& rest)
{
  const Matrix3d gradient = map.gradient(rest), change = gradient - Matrix3d::Identity();
  const SecondDerivatives second = secondDerivatives(map, rest);
  MapBounds bounds;
  bounds.determinant = gradient.determinant();
  bounds.gradient = std::sqrt(std::max(eigenvalues(change.transpose() * change)[2], 0.0));
  const Vector3d squares = eigenvalues(gradient.transpose() * gradient);
  bounds.least_stretch = std::sqrt(std::max(squares[0], 0.0));
  bounds.largest_stretch = std::sqrt(squares[2]);
  bounds.curvature = directionalBound(second);
  bounds.inverse_curvature = directionalBound(inverseSecondDerivatives(second, gradient.inverse()));
  bounds.displacement = map.displacement(rest).norm();
  bounds.speed = map.velocity(rest).norm();
  bounds.round_trip = (map.pullBack(map.position(rest)) - rest).norm();
  if (!std::isfinite(bounds.round_trip))
    bounds.round_trip = bounds.displacement;
  return bounds;
}

}  // namespace

void MapBounds::include(const MapBounds& other)
{
  determinant = std::min(determinant, other.determinant);
  gradient = std::max(gradient, other.gradient);
  least_stretch = std::min(least_stretch, other.least_stretch);
  largest_stretch = std::max(largest_stretch, other.largest_stretch);
  curvature = std::max(curvature, other.curvature);
  inverse_curvature = std::max(inverse_curvature, other.inverse_curvature);
  displacement = std::max(displacement, other.displacement);
  speed = std::max(speed, other.speed);
  round_trip = std::max(round_trip, other.round_trip);
}

SecondDerivatives secondDerivatives(const MotionMap& map, const Vector3d& rest)
{
  const Fade& fade = map.frame().fade;
  const Vector3d& a = map.frame().axis;
  const Vector3d from = rest - fade.centre, p = rest - map.frame().base;
  const double scale = 1.0 / (fade.reach * fade.reach - fade.core * fade.core);
  const double t = std::clamp((from.squaredNorm() - fade.core * fade.core) * scale, 0.0, 1.0), inner = t * (1.0 - t);
  const double weight = 1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t));
  const Vector3d weight_slope = -60.0 * inner * inner * scale * from;
  const Matrix3d weight_curvature = -240.0 * inner * (1.0 - 2.0 * t) * scale * scale * (from * from.transpose()) -
                                    60.0 * inner * inner * scale * Matrix3d::Identity();
  Matrix3d cross;
  cross << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  const MotionField& field = map.field();
  const Vector3d turned = cross * p;
  const Vector3d value = field.shift + field.linear * p + field.twist * a.dot(p) * turned;
  const Matrix3d slope = field.linear + field.twist * (a.dot(p) * cross + turned * a.transpose());
  SecondDerivatives second;
  for (int i = 0; i < 3; ++i)
  {
    const Vector3d row = slope.row(i), turn = cross.row(i);
    second[static_cast<std::size_t>(i)] = value[i] * weight_curvature + row * weight_slope.transpose() +
                                          weight_slope * row.transpose() +
                                          weight * field.twist * (a * turn.transpose() + turn * a.transpose());
  }
  return second;
}

SecondDerivatives inverseSecondDerivatives(const SecondDerivatives& second, const Matrix3d& inverse)
{
  SecondDerivatives turned, result;
  for (std::size_t i = 0; i < 3; ++i)
    turned[i] = inverse.transpose() * second[i] * inverse;
  for (int i = 0; i < 3; ++i)
    result[static_cast<std::size_t>(i)] =
        -(inverse(i, 0) * turned[0] + inverse(i, 1) * turned[1] + inverse(i, 2) * turned[2]);
  return result;
}

MapBounds mapBounds(const MotionMap& map, const std::vector<Vector3d>& points)
{
  MapBounds bounds;
  for (const Vector3d& point : points)
    if (!map.outside(point))
      bounds.include(boundsAt(map, point));
  return bounds;
}

std::vector<Vector3d> gridOf(const Fade& fade, double spacing)
{
  const int steps = static_cast<int>(std::ceil(fade.reach / spacing));
  std::vector<Vector3d> points;
  for (int i = -steps; i <= steps; ++i)
    for (int j = -steps; j <= steps; ++j)
      for (int k = -steps; k <= steps; ++k)
        if (i * i + j * j + k * k <= steps * steps)
          points.push_back(fade.centre + fade.reach / steps * Vector3d(i, j, k));
  return points;
}

}  // namespace endovascular_sim::motion
