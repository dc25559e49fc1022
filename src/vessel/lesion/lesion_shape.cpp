#include "vessel/lesion/lesion_shape.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::vessel
{
namespace
{

constexpr int kFacetsAround = 24;  // facets around the narrowed lumen
constexpr int kFacetsAlong = 32;   // facets along the lesion
constexpr double kNoReach = 2.6;   // distance from the axis, in radii, of unaffected walls (side branches)
constexpr int kBisections = 40;
constexpr double kMarginRadii = 4.0;  // length of the axis on both sides of the lesion, in radii

/** Weight of the map: 1 up to kFullReach, 0 from kNoReach, C¹ in between. */
double mapWeight(double radii)
{
  const double t = std::clamp((radii - LesionShape::kFullReach) / (kNoReach - LesionShape::kFullReach), 0.0, 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

/** Arc length on the branch at which the axis of a lesion begins [m]. */
double marginBegin(const CentrelineBranch& branch, const Lesion& lesion, double middle)
{
  const double widest = *std::max_element(branch.radii.begin(), branch.radii.end());
  return std::max(0.0, middle - 0.5 * lesion.length - kMarginRadii * widest);
}

geometry::Polyline axisAround(const CentrelineBranch& branch, const Lesion& lesion, double middle)
{
  const geometry::Polyline whole(branch.points);
  const double begin = marginBegin(branch, lesion, middle);
  const geometry::Polyline part = whole.part(begin, std::min(whole.length(), 2.0 * middle - begin));
  return geometry::Polyline(part.points(), whole.interpolate(branch.radii, middle));
}

/** Reference direction normal to an axis, rotated about the axis. */
Eigen::Vector3d sideOf(const Eigen::Vector3d& axis, double angle)
{
  const Eigen::Vector3d reference = std::abs(axis.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d across = (reference - reference.dot(axis) * axis).normalized();
  return Eigen::AngleAxisd(angle, axis) * across;
}

}  // namespace

LesionShape::LesionShape(const CentrelineBranch& branch, const Lesion& lesion, double middle)
  : lesion_(lesion), axis_(axisAround(branch, lesion, middle)), middle_(middle - marginBegin(branch, lesion, middle))
{
  const geometry::Polyline whole(branch.points);
  for (double arc : axis_.arcs())
    radii_.push_back(whole.interpolate(branch.radii, arc + middle - middle_));
  away_ = -sideOf(direction(), lesion.angle);
}

double LesionShape::narrowingAt(double from_middle) const
{
  const double x = std::abs(from_middle) / lesion_.length;
  return x < 0.5 ? 0.5 * lesion_.grade * (1.0 + std::cos(2.0 * M_PI * x)) : 0.0;
}

LesionShape::Foot LesionShape::foot(const Eigen::Vector3d& p) const
{
  const geometry::Polyline::Foot on_axis = axis_.normalPlaneFoot(p);
  const double radius = axis_.interpolate(radii_, on_axis.arc);
  return {on_axis.point, on_axis.distance, on_axis.distance / radius, on_axis.arc - middle_};
}

bool LesionShape::affects(const Eigen::Vector3d& p, double distance) const
{
  const geometry::Polyline::Foot on_axis = axis_.normalPlaneFoot(p);
  return std::abs(on_axis.arc - middle_) < 0.5 * lesion_.length + distance &&
         on_axis.distance - distance < kNoReach * axis_.interpolate(radii_, on_axis.arc);
}

LesionShape::Image LesionShape::map(const Eigen::Vector3d& p) const
{
  const geometry::Polyline::Foot on_axis = axis_.normalPlaneFoot(p);
  const double radius = axis_.interpolate(radii_, on_axis.arc);
  Image image;
  image.narrowing = narrowingAt(on_axis.arc - middle_) * mapWeight(on_axis.distance / radius);
  image.edge_length =
      std::min(2.0 * M_PI * radius * (1.0 - image.narrowing) / kFacetsAround, lesion_.length / kFacetsAlong);
  image.position = p - image.narrowing * (p - fixedPoint(on_axis, radius));
  return image;
}

/** On the axis for a concentric lesion; on the healthy wall for eccentricity 1. */
Eigen::Vector3d LesionShape::fixedPoint(const geometry::Polyline::Foot& on_axis, double radius) const
{
  if (lesion_.eccentricity == 0.0)
    return on_axis.point;
  const Eigen::Vector3d across = away_ - away_.dot(on_axis.tangent) * on_axis.tangent;
  return on_axis.point + lesion_.eccentricity * radius * across.normalized();
}

Eigen::Vector3d LesionShape::inverse(const Eigen::Vector3d& image) const
{
  const geometry::Polyline::Foot on_axis = axis_.normalPlaneFoot(image);
  const double narrowing = narrowingAt(on_axis.arc - middle_);
  if (narrowing <= 0.0)
    return image;
  const Eigen::Vector3d fixed = fixedPoint(on_axis, axis_.interpolate(radii_, on_axis.arc));
  const Eigen::Vector3d offset = image - fixed;
  double high = 1.0 / (1.0 - narrowing);
  if (foot(fixed + high * offset).radii <= kFullReach)
    return fixed + high * offset;
  // Bisection in the transition of the weight: the map is monotonic along a ray from the fixed point.
  double low = 1.0;
  for (int k = 0; k < kBisections; ++k)
  {
    const double middle = 0.5 * (low + high);
    const bool beyond = (map(fixed + middle * offset).position - fixed).dot(offset) > offset.squaredNorm();
    (beyond ? high : low) = middle;
  }
  return fixed + low * offset;
}

}  // namespace endovascular_sim::vessel
