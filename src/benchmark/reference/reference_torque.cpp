#include "benchmark/reference/reference_torque.h"

#include <cmath>

namespace endovascular_sim::benchmark
{

Transmission::Transmission(double lambda, int nodes)
{
  const double length = 0.1;
  const double edge = length / (nodes - 2);
  const double curvature = lambda / length;
  rod::Section section;
  section.length = edge * (nodes - 1);
  section.bending_stiffness = section.torsional_stiffness = 1e-3;
  section.axial_stiffness = 1e4;
  section.radius = 4e-4;
  section.density = 7000.0;
  section.rest_curvature = Eigen::Vector2d(0.0, -curvature);
  rod::Wire wire;
  wire.sections = {section};
  rod_ = rod::discretiseUniformly(wire, nodes);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  double angle = 0.0;
  state_.position.push_back(x);
  for (int j = 0; j + 1 < nodes; ++j)
  {
    angle += j > 0 ? 2.0 * std::atan(0.5 * curvature * edge) : 0.0;
    x += rod_.rest_length[j] * Eigen::Vector3d(std::cos(angle), 0.0, -std::sin(angle));
    state_.position.push_back(x);
  }
  state_.twist_angle.assign(static_cast<std::size_t>(nodes - 1), 0.0);
  hold_.position = 0.5 * rod_.rest_length[0];
}

double Transmission::rotateTo(double angle)
{
  hold_.rotation = angle;
  twist_.solve(rod_, hold_, state_);
  return state_.twist_angle.back();
}

double Transmission::proximalAngleFor(double tip)
{
  const double step = 0.25 * kDegree;
  double before = rotateTo(0.0);
  for (double proximal = step; proximal < 7.0; proximal += step)
  {
    const double now = rotateTo(proximal);
    if (now >= tip)
      return proximal - step * (now - tip) / (now - before);
    before = now;
  }
  return NAN;
}

double Transmission::snapThrough()
{
  const double step = 0.01 * kDegree;
  double before = rotateTo(0.0);
  for (double proximal = step; proximal < 7.0; proximal += step)
  {
    const double now = rotateTo(proximal);
    if (now - before > 0.5)
      return proximal - step;
    before = now;
  }
  return NAN;
}

}  // namespace endovascular_sim::benchmark
