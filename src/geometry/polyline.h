#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** Polyline parametrised by arc length. */
class Polyline
{
public:
  /** @param points two or more [m]; consecutive duplicates are dropped
   *  @param tangent_reach half length of the chord that defines the tangent at a point [m], against noise of the
   *         points; 0 takes the mean direction of both adjacent segments */
  explicit Polyline(const std::vector<Eigen::Vector3d>& points, double tangent_reach = 0.0);

  double length() const { return arcs_.back(); }                          ///< total arc length [m]
  const std::vector<Eigen::Vector3d>& points() const { return points_; }  ///< [m]
  const std::vector<double>& arcs() const { return arcs_; }               ///< arc length at each point [m]

  /** Position at an arc length [m], clamped to the ends. */
  Eigen::Vector3d at(double arc) const;

  /** Unit tangent of the segment at an arc length. */
  Eigen::Vector3d tangentAt(double arc) const;

  /** Linear interpolation of per-point values at an arc length. */
  double interpolate(const std::vector<double>& values, double arc) const;

  /** Foot point: projection of a query point onto the polyline. */
  struct Foot
  {
    double arc = 0.0;                                    ///< arc length [m]
    Eigen::Vector3d point = Eigen::Vector3d::Zero();     ///< [m]
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();  ///< unit
    double distance = 0.0;                               ///< from the query point [m]
  };
  /** Closest point of the polyline; the first one among equal distances. The cost is linear in the number of segments.
   *  */
  Foot nearest(const Eigen::Vector3d& p) const;

  /** Projection along normal planes: the point of the polyline whose normal plane contains p, near the closest point.
   *  Tangents are interpolated between the points, so the foot is a continuous function of p beside a bend, where the
   *  closest point jumps. */
  Foot normalPlaneFoot(const Eigen::Vector3d& p) const;

  /** Projection along normal planes, searched from a given segment; the cost does not depend on the number of segments.
   *  */
  Foot normalPlaneFoot(const Eigen::Vector3d& p, std::size_t segment) const;

  /** Index of the segment that contains an arc length, clamped to the first and last one. */
  std::size_t segmentAt(double arc) const;

  /** Section between two arc lengths; it contains the polyline's points in between.
   *  @pre begin < end */
  Polyline part(double begin, double end) const;

private:
  std::size_t nearestSegment(const Eigen::Vector3d& p, double& t) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> arcs_;
  std::vector<Eigen::Vector3d> tangents_;  ///< unit tangent at each point
};

}  // namespace endovascular_sim::geometry
