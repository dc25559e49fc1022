#include "rod/model/discretisation.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kSameArc = 1e-9;     // m
constexpr double kBesideCurve = 2.0;  // edges on either side of a curved section that are as short as in it

/** Integrals of section properties over a part of the wire. */
struct StretchIntegrals
{
  double bending_compliance = 0.0;
  double torsional_compliance = 0.0;
  double axial_compliance = 0.0;
  double mass = 0.0;
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
    }
    section_begin = section_end;
  }
  return sum;
}

std::vector<CurvedPart> curvedPartsOf(const Wire& wire)
{
  std::vector<CurvedPart> parts;
  double begin = 0.0;
  for (const Section& section : wire.sections)
  {
    const double end = begin + section.length;
    if (!section.rest_curvature.isZero(0.0))
      parts.push_back({begin, end, section.rest_curvature, section.bending_stiffness});
    begin = end;
  }
  return parts;
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

}  // namespace

RestAtMouth Discretisation::restAt(int node, const Mouth& mouth) const
{
  // Of a node that a layer covers in part, the rest curvature is that of a cell as curved as the covered part.
  const double whole = restAngle(curved_parts, position, node).norm();
  const double scale = whole > 0.0 ? turningAngle(rest_curvature[node]).norm() / whole : 1.0;
  RestAtMouth rest;
  rest.curvature = integratedCurvature(scale * restAngle(curved_parts, position, node, mouth));
  // The derivative of 2 tan(|φ|/2) along φ. Rest curvature that changes its direction within a node is rare.
  rest.slope =
      (scale * (1.0 + 0.25 * rest.curvature.squaredNorm())) * restAngleSlope(curved_parts, position, node, mouth);
  return rest;
}

void discretise(const Wire& wire, const std::vector<double>& position, Discretisation& d)
{
  const int n = static_cast<int>(position.size());
  const std::size_t nodes = position.size();
  d.position = position;
  d.curved_parts = curvedPartsOf(wire);
  d.first_curved = n;
  d.rest_length.resize(nodes - 1);
  d.axial_stiffness.resize(nodes - 1);
  d.cell_length.resize(nodes);
  d.bending_stiffness.resize(nodes);
  d.torsional_stiffness.resize(nodes);
  d.mass.resize(nodes);
  d.radius.resize(nodes);
  d.friction.resize(nodes);
  d.rest_curvature.resize(nodes);
  for (int j = 0; j + 1 < n; ++j)
  {
    d.rest_length[j] = position[j + 1] - position[j];
    d.axial_stiffness[j] = d.rest_length[j] / integrate(wire, position[j], position[j + 1]).axial_compliance;
  }
  for (int i = 0; i < n; ++i)
  {
    const double begin = i > 0 ? 0.5 * (position[i - 1] + position[i]) : position[i];
    const double end = i + 1 < n ? 0.5 * (position[i] + position[i + 1]) : position[i];
    const StretchIntegrals cell = integrate(wire, begin, end);
    const Section& section = sectionAt(wire, position[i]);
    d.cell_length[i] = end - begin;
    d.bending_stiffness[i] = (end - begin) / cell.bending_compliance;
    d.torsional_stiffness[i] = (end - begin) / cell.torsional_compliance;
    d.mass[i] = cell.mass;
    d.radius[i] = section.radius;
    d.friction[i] = section.friction;
    const Eigen::Vector2d rest_angle = restAngle(d.curved_parts, position, i);
    d.rest_curvature[i] = integratedCurvature(rest_angle);
    if (d.first_curved == n && !rest_angle.isZero(0.0))
      d.first_curved = i;
  }
}

Discretisation discretise(const Wire& wire, const std::vector<double>& position)
{
  Discretisation rod;
  discretise(wire, position, rod);
  return rod;
}

double massBetween(const Wire& wire, double begin, double end)
{
  return integrate(wire, begin, end).mass;
}

Discretisation discretiseUniformly(const Wire& wire, int nodes)
{
  std::vector<double> position(static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i)
    position[i] = wire.length() * i / (nodes - 1);
  return discretise(wire, position);
}

std::vector<double> resolvedPositions(const Wire& wire, int nodes, double largest_error)
{
  const double edge = wire.length() / (nodes - 1);
  const double beside = kBesideCurve * edge;
  const std::vector<CurvedPart> parts = curvedPartsOf(wire);
  std::vector<double> position = {0.0};
  for (int i = 1; i < nodes; ++i)
  {
    const double begin = position.back();
    const double end = wire.length() * i / (nodes - 1);
    double pieces = 1.0;
    for (const CurvedPart& part : parts)
    {
      const double square = part.curvature.squaredNorm();
      const double error = part.bending_stiffness * square * square * edge * edge / 24.0;
      if (part.begin - beside < end - kSameArc && part.end + beside > begin + kSameArc)
        pieces = std::max(pieces, std::ceil(std::sqrt(error / largest_error)));
    }
    for (int k = 1; k < pieces; ++k)
      position.push_back(begin + k / pieces * (end - begin));
    position.push_back(end);
  }
  return position;
}

}  // namespace endovascular_sim::rod
