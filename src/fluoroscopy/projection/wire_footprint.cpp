#include "fluoroscopy/projection/wire_footprint.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kHalfDiagonal = 0.7072;  // half the diagonal of a pixel, rounded up [pixel]
constexpr double kParallel = 1e-12;

/** Restricts [low, high] to |slope·x + offset| ≤ half. */
void limitTo(double slope, double offset, double half, double& low, double& high)
{
  if (std::abs(slope) < kParallel)
  {
    if (std::abs(offset) > half)
      high = low - 1.0;
    return;
  }
  const double a = (-half - offset) / slope, b = (half - offset) / slope;
  low = std::max(low, std::min(a, b));
  high = std::min(high, std::max(a, b));
}

}  // namespace

WireFootprint::WireFootprint(const XRayGeometry& geometry, const WireEdge& edge)
{
  const double f = geometry.focalLength();
  const Eigen::Vector3d first = edge.begin - edge.mitreDepth(edge.begin_normal) * edge.axis;
  const Eigen::Vector3d second = edge.end + edge.mitreDepth(edge.end_normal) * edge.axis;
  const double nearest = std::min(first.z(), second.z()) - edge.radius;
  // Image coordinates to the right and up.
  const Eigen::Vector2d a = first.head<2>() / first.z(), b = second.head<2>() / second.z();
  const Eigen::Vector2d ab = f * (b - a);
  const double length = ab.norm();
  along_ = length > 0.0 ? Eigen::Vector2d(ab / length) : Eigen::Vector2d::UnitX();
  across_ = Eigen::Vector2d(-along_.y(), along_.x());
  const auto reach = [&](const Eigen::Vector2d& e)
  {
    const auto at = [&](const Eigen::Vector2d& point)
    {
      const Eigen::Vector3d direction(e.x(), e.y(), -point.dot(e));
      return (direction - direction.dot(edge.axis) * edge.axis).norm();
    };
    return f * edge.radius / nearest * std::max(at(a), at(b)) + kHalfDiagonal;
  };
  const double centre = geometry.centre();
  half_length_ = 0.5 * length + reach(along_);
  half_width_ = reach(across_);
  middle_ = 0.5 * f * (a + b);
  const Eigen::Vector2d half = half_length_ * along_.cwiseAbs() + half_width_ * across_.cwiseAbs();
  const double last = geometry.pixels() - 1;
  const auto from = [last](double x) { return static_cast<int>(std::ceil(std::clamp(x, 0.0, last + 1.0))); };
  const auto to = [last](double x) { return static_cast<int>(std::floor(std::clamp(x, -1.0, last))); };
  first_column_ = from(centre + middle_.x() - half.x());
  last_column_ = to(centre + middle_.x() + half.x());
  first_row = from(centre - middle_.y() - half.y());
  last_row = to(centre - middle_.y() + half.y());
  middle_ = Eigen::Vector2d(centre + middle_.x(), centre - middle_.y());
}

WireFootprint::Columns WireFootprint::columns(int row) const
{
  const double up = middle_.y() - row;
  double low = first_column_, high = last_column_;
  limitTo(along_.x(), along_.y() * up - along_.x() * middle_.x(), half_length_, low, high);
  limitTo(across_.x(), across_.y() * up - across_.x() * middle_.x(), half_width_, low, high);
  return {static_cast<int>(std::ceil(low)), static_cast<int>(std::floor(high))};
}

}  // namespace endovascular_sim::fluoroscopy
