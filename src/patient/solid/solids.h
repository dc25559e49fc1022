#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::patient
{

/** Point of the body's frame [mm]: x left, y posterior, z superior; the origin is the centre of the fourth lumbar
 * vertebra's level at the aortic bifurcation. All lengths of this folder are in millimetres, densities in kg/m³. */
using Point = Eigen::Vector3f;
using Box = Eigen::AlignedBox3f;

/** Solid with an approximate signed distance [mm], negative inside; exact to first order at the surface. */
class Solid
{
public:
  explicit Solid(const Box& box) : box_(box) {}
  virtual ~Solid() = default;
  Solid(const Solid&) = delete;
  Solid& operator=(const Solid&) = delete;

  virtual float distance(const Point& p) const = 0;

  /** Box that contains the solid. */
  const Box& box() const { return box_; }

private:
  Box box_;
};

using SolidPointer = std::shared_ptr<const Solid>;

/** Ellipsoid with semi-axes along the columns of a rotation. */
SolidPointer ellipsoid(const Point& centre, const Point& semi_axes,
                       const Eigen::Matrix3f& axes = Eigen::Matrix3f::Identity());

/** Capsule from a to b with linearly varying radius. */
SolidPointer capsule(const Point& a, const Point& b, float radius_a, float radius_b);

/** Capsule with an elliptic section: @p radius across, @p half_height along the unit direction @p up; half_height ≥
 * radius. */
SolidPointer flatCapsule(const Point& a, const Point& b, float radius, float half_height, const Point& up);

/** Triangle of a given half thickness with rounded edges. */
SolidPointer plate(const Point& a, const Point& b, const Point& c, float half_thickness);

/** Part of a spherical shell on the side of the direction @p axis: dot(p − centre, axis) > offset. */
SolidPointer shellCap(const Point& centre, float inner, float outer, const Point& axis, float offset);

/** Function of one variable: cubic Hermite interpolation of nodes, tabulated in steps of 1 mm; constant beyond the
 * ends. */
class Profile
{
public:
  /** @param nodes increasing positions [mm] with values */
  explicit Profile(const std::vector<std::array<float, 2>>& nodes);

  float at(float position) const;

private:
  float begin_;
  std::vector<float> values_;
};

/** Rounds to 2⁻¹⁰ mm, so that last digits of trigonometric functions, which differ between machines, do not count. */
Point snapped(const Point& p);

/** Points with @p radius each, joined by capsules. */
void addChain(std::vector<SolidPointer>& solids, const std::vector<std::pair<Point, float>>& points);

}  // namespace endovascular_sim::patient
