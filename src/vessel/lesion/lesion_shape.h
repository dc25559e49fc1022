#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/polyline.h"
#include "vessel/centreline/centreline.h"
#include "vessel/model/lesion.h"

namespace endovascular_sim::vessel
{

/** Injective map of space that narrows a branch to the shape of a lesion. */
class LesionShape
{
public:
  /** Distance from the axis, in radii, up to which the map has full effect; it includes oval lumens. */
  static constexpr double kFullReach = 1.6;

  /** @param branch healthy branch without duplicate points
   *  @param middle arc length of the throat on the branch [m] */
  LesionShape(const CentrelineBranch& branch, const Lesion& lesion, double middle);

  /** Image of a point of the wall or the lumen. */
  struct Image
  {
    Eigen::Vector3d position;  ///< [m]
    double narrowing = 0.0;    ///< relative reduction of the distance from the fixed point; 0 outside the lesion
    double edge_length = 0.0;  ///< target edge length of the mesh [m]
  };
  Image map(const Eigen::Vector3d& p) const;

  /** Inverse map: the point whose image is @p image. */
  Eigen::Vector3d inverse(const Eigen::Vector3d& image) const;

  /** Foot point on the axis of the healthy branch. */
  struct Foot
  {
    Eigen::Vector3d point;     ///< [m]
    double distance = 0.0;     ///< from the axis [m]
    double radii = 0.0;        ///< distance in radii of the healthy lumen
    double from_middle = 0.0;  ///< signed arc length from the throat [m]
  };
  Foot foot(const Eigen::Vector3d& p) const;

  /** Relative loss of diameter at an arc length from the throat. */
  double narrowingAt(double from_middle) const;

  /** True if the lesion affects points within a distance [m] of a point. */
  bool affects(const Eigen::Vector3d& p, double distance) const;

  Eigen::Vector3d middle() const { return axis_.at(middle_); }  ///< throat on the healthy axis [m]
  Eigen::Vector3d direction() const { return axis_.normalPlaneFoot(middle()).tangent; }  ///< tangent at the throat

private:
  /** Fixed point of the map in a cross-section. */
  Eigen::Vector3d fixedPoint(const geometry::Polyline::Foot& on_axis, double radius) const;

  Lesion lesion_;
  geometry::Polyline axis_;    ///< axis of the lesion with a margin
  double middle_;              ///< arc length of the throat on axis_ [m]
  std::vector<double> radii_;  ///< radius at each point of axis_ [m]
  Eigen::Vector3d away_;       ///< unit vector at the throat, opposite to the plaque
};

}  // namespace endovascular_sim::vessel
