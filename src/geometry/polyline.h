#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** A line of straight segments, measured by its arc length. */
class Polyline
{
public:
  /** @param points [m], two or more; those that repeat their neighbour are left out
   *  @param tangent_reach directions at the points are those of chords that reach this far to both sides [m]: noise of
   *         the points does not turn them; 0: the mean of both segments */
  explicit Polyline(const std::vector<Eigen::Vector3d>& points, double tangent_reach = 0.0);

  double length() const { return arcs_.back(); }                          ///< [m]
  const std::vector<Eigen::Vector3d>& points() const { return points_; }  ///< [m]
  const std::vector<double>& arcs() const { return arcs_; }               ///< of the points, from the first one [m]

  /** The line at an arc length; the end points beyond it. @param arc [m] */
  Eigen::Vector3d at(double arc) const;

  /** Unit vector along the line. */
  Eigen::Vector3d tangentAt(double arc) const;

  /** Linear interpolation of values given at points(). */
  double interpolate(const std::vector<double>& values, double arc) const;

  /** A point of the line that belongs to another point. */
  struct Foot
  {
    double arc = 0.0;                                    ///< [m]
    Eigen::Vector3d point = Eigen::Vector3d::Zero();     ///< [m]
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();  ///< unit
    double distance = 0.0;                               ///< [m]
  };
  /** Of equally near ones the first. Looks at every segment. */
  Foot nearest(const Eigen::Vector3d& p) const;

  /** The point of the line in whose normal plane p lies, near the nearest one. Normal planes turn evenly between the
   *  line's points, so that this one, unlike the nearest, goes evenly along with p beside a bend. */
  Foot section(const Eigen::Vector3d& p) const;

  /** The same, near a segment that is known to be near: time does not grow with the line's length. */
  Foot section(const Eigen::Vector3d& p, std::size_t segment) const;

  /** The segment that holds an arc length. */
  std::size_t segmentAt(double arc) const;

  /** The part between two arc lengths, with the line's own points in it. @pre begin < end */
  Polyline part(double begin, double end) const;

private:
  std::size_t nearestSegment(const Eigen::Vector3d& p, double& t) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> arcs_;
  std::vector<Eigen::Vector3d> tangents_;  ///< unit, at the points
};

}  // namespace endovascular_sim::geometry
