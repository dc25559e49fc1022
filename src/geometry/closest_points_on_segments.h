#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

inline double clampedShare(double value)
{
  return std::max(0.0, std::min(1.0, value));
}

/** Parameters of the closest points of two segments p1q1 and p2q2, each in [0,1] (Ericson 2005, §5.1.9). */
struct SegmentPair
{
  double first = 0.0;
  double second = 0.0;
};
SegmentPair closestPointsOfSegments(const Eigen::Vector3d& p1, const Eigen::Vector3d& q1, const Eigen::Vector3d& p2,
                                    const Eigen::Vector3d& q2);

/** A segment with a cone round it. */
struct TaperedSegment
{
  /** @param taper the radius at q minus that at p [m] */
  TaperedSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& q, double taper);

  Eigen::Vector3d begin;
  double length;              ///< [m]
  Eigen::Vector3d direction;  ///< unit
  double slope;               ///< of the radius along it
};

/** The same where a cone round the first segment comes closest to the second one: least distance of the axis minus the
 *  cone's radius there. A convex function, minimised in closed form: where the ends allow it, the axis is seen from the
 *  second segment at the angle whose sine is the cone's slope. */
SegmentPair closestPointsOfCone(const TaperedSegment& cone, const Eigen::Vector3d& p2, const Eigen::Vector3d& q2);

}  // namespace endovascular_sim::geometry
