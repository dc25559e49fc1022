#include "geometry/closest_points_on_segments.h"

#include <cmath>
#include <limits>

namespace endovascular_sim::geometry
{
namespace
{

constexpr double kParallel = 1e-12;  // squared sine

/** Distance along a cone's axis from the foot of a perpendicular to the point closest to the perpendicular's other end.
 *  @param height length of the perpendicular [m]
 *  @param squared_sine squared sine of the angle between the axis and the line through the other end; 1 for a point
 *  @param slope change of the cone's radius per length, less than that sine */
double shift(double height, double squared_sine, double slope)
{
  return slope * height / std::sqrt(squared_sine * (squared_sine - slope * slope));
}

}  // namespace

SegmentPair closestPointsOfSegments(const Eigen::Vector3d& p1, const Eigen::Vector3d& q1, const Eigen::Vector3d& p2,
                                    const Eigen::Vector3d& q2)
{
  const Eigen::Vector3d d1 = q1 - p1;
  const Eigen::Vector3d d2 = q2 - p2;
  const Eigen::Vector3d r = p1 - p2;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double f = d2.dot(r);
  const double c = d1.dot(r);
  const double b = d1.dot(d2);
  const double determinant = a * e - b * b;
  SegmentPair pair;
  pair.first = determinant > 1e-12 * a * e ? clampedParameter((b * f - c * e) / determinant) : 0.5;
  pair.second = (b * pair.first + f) / e;
  if (pair.second < 0.0)
  {
    pair.second = 0.0;
    pair.first = clampedParameter(-c / a);
  }
  else if (pair.second > 1.0)
  {
    pair.second = 1.0;
    pair.first = clampedParameter((b - c) / a);
  }
  return pair;
}

TaperedSegment::TaperedSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& q, double taper)
  : begin(p), length((q - p).norm()), direction((q - p) / length), slope(taper / length)
{
}

SegmentPair closestPointsOfCone(const TaperedSegment& cone, const Eigen::Vector3d& p2, const Eigen::Vector3d& q2)
{
  const Eigen::Vector3d& p1 = cone.begin;
  const Eigen::Vector3d& u = cone.direction;
  const double length = cone.length;
  const double slope = cone.slope;
  const double length2 = (q2 - p2).norm();
  const Eigen::Vector3d v = (q2 - p2) / length2;
  const Eigen::Vector3d from = p1 - p2;
  const double cosine = u.dot(v);
  const double squared_sine = 1.0 - cosine * cosine;
  const auto nearestOnSecond = [&](double along) { return clampedParameter((from + along * u).dot(v) / length2); };
  const auto closestToPoint = [&](const Eigen::Vector3d& point)  // coordinate on the axis
  {
    const double foot = (point - p1).dot(u);
    const double height = (p1 + foot * u - point).norm();
    return std::abs(slope) < 1.0 ? foot + shift(height, 1.0, slope) : (slope > 0.0 ? length : 0.0);
  };
  double along = 0.0;
  if (squared_sine > std::max(kParallel, slope * slope * (1.0 + kParallel)))
  {
    const double foot = (cosine * from.dot(v) - from.dot(u)) / squared_sine;
    const double foot2 = (from + foot * u).dot(v);
    along = foot + shift((from + foot * u - foot2 * v).norm(), squared_sine, slope);
    const double share = (foot2 + (along - foot) * cosine) / length2;
    if (share < 0.0 || share > 1.0)
      along = closestToPoint(share < 0.0 ? p2 : q2);
  }
  else
  {
    // The cone is steeper than the angle between the lines: the minimum is at an end of one of them.
    double least = std::numeric_limits<double>::infinity();
    for (const double end : {closestToPoint(p2), closestToPoint(q2), slope > 0.0 ? length : 0.0})
    {
      const double at = std::max(0.0, std::min(length, end));
      const double reached = (from + at * u - nearestOnSecond(at) * (q2 - p2)).norm() - slope * at;
      if (reached < least)
        along = at;
      least = std::min(least, reached);
    }
  }
  along = std::max(0.0, std::min(length, along));
  return {along / length, nearestOnSecond(along)};
}

}  // namespace endovascular_sim::geometry
