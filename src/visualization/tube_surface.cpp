#include "visualization/tube_surface.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/units.h"

namespace endovascular_sim::visualization
{
namespace
{

using units::kPi;
constexpr double kCoinciding = 1e-9;   ///< distance below which adjacent points coincide [m]
constexpr double kLargestValue = 1e3;  ///< of coordinates and radii [m]; single precision holds their squares

/** Arbitrary unit vector normal to @p tangent. */
Eigen::Vector3d anyNormal(const Eigen::Vector3d& tangent)
{
  Eigen::Index smallest = 0;
  tangent.cwiseAbs().minCoeff(&smallest);
  return tangent.cross(Eigen::Vector3d::Unit(smallest)).normalized();
}

void appendVertex(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, const TranslucentColour& colour,
                  Surface& surface)
{
  surface.positions.push_back(position);
  surface.normals.push_back(normal);
  surface.colours.push_back(colour);
}

}  // namespace

void Surface::clear()
{
  positions.clear();
  normals.clear();
  colours.clear();
  triangles.clear();
}

void TubeAxis::clear()
{
  points.clear();
  radii.clear();
  colours.clear();
}

void TubeAxis::add(const Eigen::Vector3d& point, double radius, const TranslucentColour& colour)
{
  points.push_back(point);
  radii.push_back(radius);
  colours.push_back(colour);
}

TubeBuilder::TubeBuilder(int sides) : circle_(static_cast<std::size_t>(std::max(sides, 3)))
{
  for (std::size_t k = 0; k < circle_.size(); ++k)
  {
    const double angle = 2.0 * kPi * static_cast<double>(k) / static_cast<double>(circle_.size());
    circle_[k] = Eigen::Vector2d(std::cos(angle), std::sin(angle)).cast<float>();
  }
}

void TubeBuilder::append(const TubeAxis& axis, Surface& surface)
{
  kept_.clear();
  for (std::size_t i = 0; i < axis.points.size(); ++i)
    if (kept_.empty() || (axis.points[i] - axis.points[kept_.back()]).squaredNorm() > kCoinciding * kCoinciding)
      kept_.push_back(i);
  if (kept_.size() < 2)
    return;

  const auto sides = static_cast<std::uint32_t>(circle_.size());
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  normal_.setZero();
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  Eigen::Vector3d first_tangent = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < kept_.size(); ++k)
  {
    const Eigen::Vector3d& centre = axis.points[kept_[k]];
    const Eigen::Vector3d after =
        k + 1 < kept_.size() ? Eigen::Vector3d((axis.points[kept_[k + 1]] - centre).normalized()) : before;
    const Eigen::Vector3d sum = before + after;
    // At a reversal of the curve the bisector vanishes. The outgoing segment then gives the tangent.
    const Eigen::Vector3d tangent = sum.squaredNorm() > 1e-12 ? Eigen::Vector3d(sum.normalized()) : after;
    if (k == 0)
      first_tangent = tangent;
    appendRing(centre, tangent, kept_[k], axis, surface);
    before = after;
  }
  for (std::uint32_t k = 0; k + 1 < kept_.size(); ++k)
    for (std::uint32_t side = 0; side < sides; ++side)
    {
      const std::uint32_t next = side + 1 < sides ? side + 1 : 0;
      const std::uint32_t a = first + k * sides + side, b = first + k * sides + next;
      for (const std::uint32_t corner : {a, b, a + sides, a + sides, b, b + sides})
        surface.triangles.push_back(corner);
    }
  const std::uint32_t last_ring = first + static_cast<std::uint32_t>(kept_.size() - 1) * sides;
  appendDisc(kept_.front(), -first_tangent, first, false, axis, surface);
  appendDisc(kept_.back(), before, last_ring, true, axis, surface);
}

void TubeBuilder::appendRing(const Eigen::Vector3d& centre, const Eigen::Vector3d& tangent, std::size_t point,
                             const TubeAxis& axis, Surface& surface)
{
  normal_ -= normal_.dot(tangent) * tangent;
  normal_ = normal_.squaredNorm() > 1e-12 ? Eigen::Vector3d(normal_.normalized()) : anyNormal(tangent);
  const Eigen::Vector3f centre_f = centre.cast<float>();
  const Eigen::Vector3f normal = normal_.cast<float>();
  const Eigen::Vector3f binormal = tangent.cross(normal_).cast<float>();
  const auto radius = static_cast<float>(axis.radii[point]);
  for (const Eigen::Vector2f& direction : circle_)
  {
    const Eigen::Vector3f outward = direction.x() * normal + direction.y() * binormal;
    appendVertex(centre_f + radius * outward, outward, axis.colours[point], surface);
  }
}

void TubeBuilder::appendDisc(std::size_t point, const Eigen::Vector3d& outward, std::uint32_t ring, bool is_end,
                             const TubeAxis& axis, Surface& surface)
{
  const auto sides = static_cast<std::uint32_t>(circle_.size());
  const auto centre = static_cast<std::uint32_t>(surface.positions.size());
  const Eigen::Vector3f normal = outward.cast<float>();
  appendVertex(axis.points[point].cast<float>(), normal, axis.colours[point], surface);
  for (std::uint32_t side = 0; side < sides; ++side)  // copies of the ring's vertices, with the normal of the disc
    appendVertex(Eigen::Vector3f(surface.positions[ring + side]), normal, axis.colours[point], surface);
  for (std::uint32_t side = 0; side < sides; ++side)
  {
    const std::uint32_t a = centre + 1 + side, b = centre + 1 + (side + 1 < sides ? side + 1 : 0);
    for (const std::uint32_t corner : {centre, is_end ? a : b, is_end ? b : a})
      surface.triangles.push_back(corner);
  }
}

const char* problemOfTube(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& radii)
{
  if (points.empty())
    return "empty";
  if (points.size() != radii.size())
    return "inconsistent lengths";
  const auto is_drawable = [](const Eigen::Vector3d& p)
  { return p.allFinite() && p.cwiseAbs().maxCoeff() < kLargestValue; };
  if (!std::all_of(points.begin(), points.end(), is_drawable) ||
      !std::all_of(radii.begin(), radii.end(), [](double r) { return std::isfinite(r) && r < kLargestValue; }))
    return "not finite";
  if (std::any_of(radii.begin(), radii.end(), [](double r) { return r < 0.0; }))
    return "negative radius";
  return nullptr;
}

}  // namespace endovascular_sim::visualization
