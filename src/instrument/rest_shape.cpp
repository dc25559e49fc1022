#include "instrument/rest_shape.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::instrument
{
namespace
{

/** Point at a distance along an arc whose curvature vector is constant in the material frame. */
RestPoint advance(const RestPoint& begin, const Eigen::Vector2d& rest_curvature, double distance)
{
  RestPoint end = begin;
  end.arc_length += distance;
  const double curvature = rest_curvature.norm();
  if (curvature == 0.0)
  {
    end.position += distance * begin.tangent;
    return end;
  }
  // Curvature vector κb = ω₁ d2 − ω₂ d1 with ω = (κb·d2, −κb·d1). The frame rotates about κb, so κb is constant in
  // space.
  const Eigen::Vector3d d2 = begin.tangent.cross(begin.d1);
  const Eigen::Vector3d axis = (rest_curvature[0] * d2 - rest_curvature[1] * begin.d1) / curvature;
  const double angle = curvature * distance;
  const Eigen::AngleAxisd turn(angle, axis);
  end.position += (std::sin(angle) * begin.tangent + (1.0 - std::cos(angle)) * axis.cross(begin.tangent)) / curvature;
  end.tangent = turn * begin.tangent;
  end.d1 = turn * begin.d1;
  return end;
}

}  // namespace

std::vector<RestPoint> restShape(const rod::Wire& wire, double spacing)
{
  std::vector<RestPoint> points(1);
  RestPoint begin = points.front();
  for (std::size_t k = 0; k < wire.sections.size(); ++k)
  {
    const rod::Section& section = wire.sections[k];
    begin.section = k;
    const int pieces = std::max(1, static_cast<int>(std::ceil(section.length / spacing)));
    for (int i = 1; i <= pieces; ++i)
      points.push_back(advance(begin, section.rest_curvature, section.length * i / pieces));
    begin = points.back();
  }
  return points;
}

}  // namespace endovascular_sim::instrument
