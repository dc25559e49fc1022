#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Piece of a tube: straight, or a circular arc. */
struct TubePiece
{
  double length = 0.0;       ///< arc length of the axis [m]
  double curvature = 0.0;    ///< curvature of the axis [1/m]; 0 for a straight piece
  double plane_angle = 0.0;  ///< bending direction about the axis, from the parallel-transported `up` [rad]
};

/** Tube of circular cross-section. */
struct TubeShape
{
  double radius = 0.0;        ///< [m]
  double facet_length = 0.0;  ///< longest facet along the wall [m]
  int facets_around = 32;     ///< facets around the circumference
  std::vector<TubePiece> pieces;

  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< start of the axis [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit tangent of the axis at the start
  Eigen::Vector3d up = Eigen::Vector3d::UnitX();         ///< direction of plane_angle = 0; not parallel to direction
};

/** Length of the straight run-in before the start, in radii; the start lies inside the mesh. */
constexpr double kTubeRunIn = 4.0;

/** Closed mesh of the tube with flat end caps. Vertices lie exactly on the wall; the centres of the inscribed facets
 *  are radius·(1 − cos(π/facets_around)) inside.
 *  @throws InputError for a tube without pieces, a bend tighter than its radius, or a direction of zero length */
geometry::TriangleMesh tubeMesh(const TubeShape& shape);

/** Exact axis of the tube as one branch named "tube", from the cap of the run-in to the far cap. */
CentrelineTree tubeCentreline(const TubeShape& shape);

}  // namespace endovascular_sim::vessel
