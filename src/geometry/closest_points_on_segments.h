#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** Parameter on a segment, clamped to [0,1]. */
inline double clampedParameter(double value)
{
  return std::max(0.0, std::min(1.0, value));
}

/** Parameters of the closest points of two segments, each in [0,1]. */
struct SegmentPair
{
  double first = 0.0;
  double second = 0.0;
};

/** Closest points of the segments p1q1 and p2q2 (Ericson 2005, §5.1.9). */
SegmentPair closestPointsOfSegments(const Eigen::Vector3d& p1, const Eigen::Vector3d& q1, const Eigen::Vector3d& p2,
                                    const Eigen::Vector3d& q2);

/** Truncated cone, given by the segment pq of its axis and its taper. */
struct TaperedSegment
{
  /** @param taper radius of the cone at q minus its radius at p [m] */
  TaperedSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& q, double taper);

  Eigen::Vector3d begin;
  double length;              ///< [m]
  Eigen::Vector3d direction;  ///< unit
  double slope;               ///< derivative of the radius along the axis [1]
};

/** Closest points of a cone and the segment p2q2: minimum of the distance from the cone's axis minus the cone's radius.
 *
 *  The function is convex and minimised in closed form. At a minimum between the ends of the axis, the line between the
 *  closest points is tilted against the plane normal to the axis. The sine of the tilt is the slope. */
SegmentPair closestPointsOfCone(const TaperedSegment& cone, const Eigen::Vector3d& p2, const Eigen::Vector3d& q2);

}  // namespace endovascular_sim::geometry
