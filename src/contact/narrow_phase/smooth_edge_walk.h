#pragma once

#include <optional>

#include <Eigen/Core>

#include "contact/narrow_phase/smooth_foot.h"

namespace endovascular_sim::contact
{

/** Minima of the distance between an edge of the wire and a smooth wall. */
class SmoothEdgeWalk
{
public:
  /** @param search must outlive the object
   *  @param along from the edge's begin to its end [m]
   *  @param taper radius at the end minus radius at the begin [m] */
  SmoothEdgeWalk(const SmoothFootSearch& search, const Eigen::Vector3d& begin, const Eigen::Vector3d& along,
                 double taper)
    : search_(search), begin_(begin), along_(along), taper_(taper), length_(along.norm())
  {
  }

  /** A point of the edge with its foot. */
  struct Place
  {
    double parameter;  ///< 0 at the begin, 1 at the end
    SmoothFoot foot;
    double slope;  ///< derivative of the wire's gap by the parameter [m]
    double gap;    ///< distance less the change of the radius from the begin [m]
  };

  Place placeOf(double parameter, const SmoothFoot& foot) const;

  /** The minimum between places with a falling and a rising gap, by the Illinois method; the lowest place visited if a
   *  foot jumps. */
  Place minimumBetween(Place low, Place high) const;

  /** The minimum downhill from a point of the edge, at this point if it is one or if the foot jumps further on; none
   *  where the gap falls to the edge's end.
   *  @param triangle where the search of the point's foot begins */
  std::optional<Place> minimumFrom(double parameter, int triangle) const;

private:
  Place placeFrom(double parameter, const SmoothFoot& near) const;

  const SmoothFootSearch& search_;
  const Eigen::Vector3d begin_, along_;
  const double taper_, length_;
};

}  // namespace endovascular_sim::contact
