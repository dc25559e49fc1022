#pragma once

#include "fluoroscopy/projection/wire_edge.h"
#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Conservative footprint of an edge: a rectangle along the image of its axis.
 *
 *  A point of the edge is x + ρw with x on the axis extended by the mitres, ρ ≤ r, and w a unit vector normal to the
 *  axis. Its image is displaced from that of x by f ρ J w/(x_z + ρ w_z) with J = (I | −x_xy/x_z). The displacement
 *  along an image direction e is at most f r |Jᵀe − (Jᵀe·a) a|/(z − r). This bound is a convex function of x_xy/x_z and
 *  takes its maximum at an end. */
class WireFootprint
{
public:
  WireFootprint(const XRayGeometry& geometry, const WireEdge& edge);

  /** Columns of a row from first to last; none if last < first. */
  struct Columns
  {
    int first, last;
  };
  Columns columns(int row) const;

  int first_row, last_row;

private:
  int first_column_, last_column_;   ///< of the bounding box
  Eigen::Vector2d along_, across_;   ///< unit vectors in image coordinates to the right and up
  Eigen::Vector2d middle_;           ///< column and row of the centre [pixel]
  double half_length_, half_width_;  ///< [pixel]
};

}  // namespace endovascular_sim::fluoroscopy
