#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/polyline.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::vessel
{

/** The map of space by which a lesion narrows its branch. One to one: walls do not fold. */
class LesionShape
{
public:
  /** Radii from the axis up to which the wall takes part wholly, so that oval lumens do. */
  static constexpr double kFullReach = 1.6;

  /** @param branch before any lesion, without repeated points @param middle of the lesion along it [m] */
  LesionShape(const CentrelineBranch& branch, const Lesion& lesion, double middle);

  /** Where a point of the wall or the lumen goes, and what it meets there. */
  struct Image
  {
    Eigen::Vector3d position;  ///< [m]
    double lost = 0.0;         ///< share of the distances across the axis; 0 outside the lesion
    double facet = 0.0;        ///< edge length that the mesh should have there [m]
  };
  Image at(const Eigen::Vector3d& p) const;

  /** The point of which at() makes @p image. */
  Eigen::Vector3d before(const Eigen::Vector3d& image) const;

  /** Foot of a point on the healthy branch's axis, as a point and a distance in radii of the healthy lumen. */
  struct Foot
  {
    Eigen::Vector3d point;
    double distance = 0.0;  ///< [m]
    double radii = 0.0;
    double from_middle = 0.0;  ///< along the axis [m]
  };
  Foot foot(const Eigen::Vector3d& p) const;

  /** Share of the diameter that is lost at a distance along the axis from the lesion's middle. */
  double lostAt(double from_middle) const;

  /** Whether the lesion moves something within a distance [m] of a point. */
  bool isNear(const Eigen::Vector3d& p, double distance) const;

  Eigen::Vector3d middle() const { return axis_.at(middle_); }                   ///< of the healthy axis [m]
  Eigen::Vector3d direction() const { return axis_.section(middle()).tangent; }  ///< of the axis there

private:
  /** The point of its section towards which a section shrinks. */
  Eigen::Vector3d fixedPoint(const geometry::Polyline::Foot& on_axis, double radius) const;

  Lesion lesion_;
  geometry::Polyline axis_;    ///< the lesion and some radii more
  double middle_;              ///< along axis_ [m]
  std::vector<double> radii_;  ///< per point of axis_ [m]
  Eigen::Vector3d away_;       ///< unit, from the plaque across the axis in the lesion's middle
};

}  // namespace endovascular_sim::vessel
