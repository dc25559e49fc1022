#include "rod/discretisation.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

/** Integrals of a section property over a stretch of wire. */
struct StretchIntegrals
{
  double bending_compliance = 0.0;
  double torsional_compliance = 0.0;
  double axial_compliance = 0.0;
  double mass = 0.0;
  Eigen::Vector2d rest_angle = Eigen::Vector2d::Zero();
};

StretchIntegrals integrate(const Wire& wire, double begin, double end)
{
  StretchIntegrals sum;
  double section_begin = 0.0;
  for (const Section& section : wire.sections)
  {
    const double section_end = section_begin + section.length;
    const double overlap = std::min(end, section_end) - std::max(begin, section_begin);
    if (overlap > 0.0)
    {
      sum.bending_compliance += overlap / section.bending_stiffness;
      sum.torsional_compliance += overlap / section.torsional_stiffness;
      sum.axial_compliance += overlap / section.axial_stiffness;
      sum.mass += overlap * section.density * M_PI * section.radius * section.radius;
      sum.rest_angle += overlap * section.rest_curvature;
    }
    section_begin = section_end;
  }
  return sum;
}

const Section& sectionAt(const Wire& wire, double position)
{
  double end = 0.0;
  for (const Section& section : wire.sections)
  {
    end += section.length;
    if (position <= end)
      return section;
  }
  return wire.sections.back();
}

/** Integrated curvature whose turning angle is @p angle. */
Eigen::Vector2d integratedCurvature(const Eigen::Vector2d& angle)
{
  const double magnitude = angle.norm();
  return magnitude > 0.0 ? Eigen::Vector2d(angle * (2.0 * std::tan(0.5 * magnitude) / magnitude))
                         : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

}  // namespace

Discretisation discretise(const Wire& wire, const std::vector<double>& position)
{
  Discretisation d;
  const int n = static_cast<int>(position.size());
  d.position = position;
  d.first_curved = n;
  for (int i = 0; i + 1 < n; ++i)
  {
    d.rest_length.push_back(position[i + 1] - position[i]);
    d.axial_stiffness.push_back(d.rest_length[i] / integrate(wire, position[i], position[i + 1]).axial_compliance);
  }
  for (int i = 0; i < n; ++i)
  {
    const double begin = i > 0 ? 0.5 * (position[i - 1] + position[i]) : position[i];
    const double end = i + 1 < n ? 0.5 * (position[i] + position[i + 1]) : position[i];
    const StretchIntegrals cell = integrate(wire, begin, end);
    const Section& section = sectionAt(wire, position[i]);
    d.cell_length.push_back(end - begin);
    d.bending_stiffness.push_back((end - begin) / cell.bending_compliance);
    d.torsional_stiffness.push_back((end - begin) / cell.torsional_compliance);
    d.mass.push_back(cell.mass);
    d.radius.push_back(section.radius);
    d.friction.push_back(section.friction);
    d.rest_curvature.push_back(integratedCurvature(cell.rest_angle));
    if (d.first_curved == n && cell.rest_angle.squaredNorm() > 0.0)
      d.first_curved = i;
  }
  return d;
}

Discretisation discretiseUniformly(const Wire& wire, int nodes)
{
  std::vector<double> position(static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i)
    position[i] = wire.length() * i / (nodes - 1);
  return discretise(wire, position);
}

}  // namespace endovascular_sim::rod
