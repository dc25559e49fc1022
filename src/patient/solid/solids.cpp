#include "patient/solid/solids.h"

#include <algorithm>
#include <cmath>

#include "geometry/closest_point_on_triangle.h"

namespace endovascular_sim::patient
{
namespace
{

Box boxAround(const Point& a, const Point& b, float margin)
{
  const Point wide = Point::Constant(margin);
  return {a.cwiseMin(b) - wide, a.cwiseMax(b) + wide};
}

class Ellipsoid : public Solid
{
public:
  Ellipsoid(const Point& centre, const Point& semi_axes, const Eigen::Matrix3f& axes)
    : Solid(boxOf(centre, semi_axes, axes)),
      centre_(centre),
      inverse_(semi_axes.cwiseInverse()),
      axes_(axes.transpose())
  {
  }

  float distance(const Point& p) const override
  {
    const Point q = (axes_ * (p - centre_)).cwiseProduct(inverse_);
    const float level = q.norm(), slope = q.cwiseProduct(inverse_).norm();
    return slope > 0.0F ? level * (level - 1.0F) / slope : -1.0F / inverse_.maxCoeff();
  }

private:
  static Box boxOf(const Point& centre, const Point& semi_axes, const Eigen::Matrix3f& axes)
  {
    const Point half = (axes * semi_axes.asDiagonal()).rowwise().norm();
    return {centre - half, centre + half};
  }

  Point centre_;
  Point inverse_;
  Eigen::Matrix3f axes_;
};

class Capsule : public Solid
{
public:
  Capsule(const Point& a, const Point& b, float radius_a, float radius_b)
    : Solid(boxAround(a, b, std::max(radius_a, radius_b))),
      a_(a),
      d_(b - a),
      radius_(radius_a),
      change_(radius_b - radius_a),
      inverse_(1.0F / std::max(d_.squaredNorm(), 1e-6F))
  {
  }

  float distance(const Point& p) const override
  {
    const Point q = p - a_;
    const float t = std::clamp(q.dot(d_) * inverse_, 0.0F, 1.0F);
    return (q - t * d_).norm() - (radius_ + t * change_);
  }

private:
  Point a_, d_;
  float radius_, change_, inverse_;
};

class FlatCapsule : public Solid
{
public:
  FlatCapsule(const Point& a, const Point& b, float radius, float half_height, const Point& up)
    : Solid(boxAround(a, b, half_height)),
      a_(a),
      up_(up),
      radius_(radius),
      squeeze_(radius / half_height - 1.0F),
      d_(squeezed(b - a)),
      inverse_(1.0F / std::max(d_.squaredNorm(), 1e-6F))
  {
  }

  float distance(const Point& p) const override
  {
    const Point q = squeezed(p - a_);
    const Point off = q - std::clamp(q.dot(d_) * inverse_, 0.0F, 1.0F) * d_;
    const float length = off.norm();
    if (length < 1e-6F)
      return -radius_;
    return (length - radius_) / squeezed(off / length).norm();
  }

private:
  Point squeezed(const Point& p) const { return p + squeeze_ * up_.dot(p) * up_; }

  Point a_, up_;
  float radius_, squeeze_;
  Point d_;
  float inverse_;
};

class Plate : public Solid
{
public:
  Plate(const Point& a, const Point& b, const Point& c, float half_thickness)
    : Solid(boxAround(a.cwiseMin(b), a.cwiseMax(b), half_thickness).merged(boxAround(c, c, half_thickness))),
      a_(a.cast<double>()),
      b_(b.cast<double>()),
      c_(c.cast<double>()),
      half_thickness_(half_thickness)
  {
  }

  float distance(const Point& p) const override
  {
    const Eigen::Vector3d q = p.cast<double>();
    return static_cast<float>((geometry::closestPointOnTriangle(q, a_, b_, c_).point - q).norm()) - half_thickness_;
  }

private:
  Eigen::Vector3d a_, b_, c_;
  float half_thickness_;
};

class ShellCap : public Solid
{
public:
  ShellCap(const Point& centre, float inner, float outer, const Point& axis, float offset)
    : Solid(boxAround(centre, centre, outer)),
      centre_(centre),
      axis_(axis),
      middle_(0.5F * (inner + outer)),
      half_(0.5F * (outer - inner)),
      offset_(offset)
  {
  }

  float distance(const Point& p) const override
  {
    const Point q = p - centre_;
    return std::max(std::abs(q.norm() - middle_) - half_, offset_ - axis_.dot(q));
  }

private:
  Point centre_, axis_;
  float middle_, half_, offset_;
};

}  // namespace

SolidPointer ellipsoid(const Point& centre, const Point& semi_axes, const Eigen::Matrix3f& axes)
{
  return std::make_shared<Ellipsoid>(centre, semi_axes, axes);
}

SolidPointer capsule(const Point& a, const Point& b, float radius_a, float radius_b)
{
  return std::make_shared<Capsule>(snapped(a), snapped(b), radius_a, radius_b);
}

SolidPointer flatCapsule(const Point& a, const Point& b, float radius, float half_height, const Point& up)
{
  return std::make_shared<FlatCapsule>(snapped(a), snapped(b), radius, half_height, up);
}

SolidPointer plate(const Point& a, const Point& b, const Point& c, float half_thickness)
{
  return std::make_shared<Plate>(a, b, c, half_thickness);
}

SolidPointer shellCap(const Point& centre, float inner, float outer, const Point& axis, float offset)
{
  return std::make_shared<ShellCap>(centre, inner, outer, axis.normalized(), offset);
}

Profile::Profile(const std::vector<std::array<float, 2>>& nodes) : begin_(nodes.front()[0])
{
  const auto slope = [&](std::size_t i)
  {
    const std::size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, nodes.size() - 1);
    return (nodes[b][1] - nodes[a][1]) / (nodes[b][0] - nodes[a][0]);
  };
  std::size_t k = 0;
  for (float x = begin_; x <= nodes.back()[0]; x += 1.0F)
  {
    while (k + 2 < nodes.size() && x > nodes[k + 1][0])
      ++k;
    const float h = nodes[k + 1][0] - nodes[k][0], t = (x - nodes[k][0]) / h, s = 1.0F - t;
    values_.push_back(s * s * ((1.0F + 2.0F * t) * nodes[k][1] + t * h * slope(k)) +
                      t * t * ((1.0F + 2.0F * s) * nodes[k + 1][1] - s * h * slope(k + 1)));
  }
}

float Profile::at(float position) const
{
  const float x = std::clamp(position - begin_, 0.0F, static_cast<float>(values_.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(x), values_.size() - 2);
  return values_[k] + (x - static_cast<float>(k)) * (values_[k + 1] - values_[k]);
}

Point snapped(const Point& p)
{
  return (p * 1024.0F).array().round().matrix() / 1024.0F;
}

void addChain(std::vector<SolidPointer>& solids, const std::vector<std::pair<Point, float>>& points)
{
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    solids.push_back(capsule(points[i].first, points[i + 1].first, points[i].second, points[i + 1].second));
}

}  // namespace endovascular_sim::patient
