#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** A piece of a channel: straight, or an arc of a circle. */
struct TubePiece
{
  double length = 0.0;       ///< arc length of its axis [m]
  double curvature = 0.0;    ///< 1/m, 0 for a straight piece
  double plane_angle = 0.0;  ///< direction in which it bends, from the transported `up` about the axis [rad]
};

/** A channel of circular cross-section. */
struct TubeShape
{
  double radius = 0.0;        ///< [m]
  double facet_length = 0.0;  ///< longest facet along the wall [m]
  int facets_around = 32;     ///< facets around the circumference
  std::vector<TubePiece> pieces;

  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< start of the axis [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< of the axis at the start, unit
  Eigen::Vector3d up = Eigen::Vector3d::UnitX();         ///< where plane_angle is zero; not parallel to direction
};

/** Straight channel behind the start, in radii, so that the start lies inside the mesh. */
constexpr double kTubeRunIn = 4.0;

/** Closed mesh of the channel with flat end caps. Its vertices lie on the wall exactly, so the facets are inscribed:
 *  their middles are radius·(1 − cos(π/facets_around)) inside of it.
 *  @throws InputError for a tube without pieces, a bend tighter than its radius, or a direction of zero length */
geometry::TriangleMesh tubeMesh(const TubeShape& shape);

/** The exact axis of the channel as one branch named "tube", from the run-in's cap to the far cap. */
CentrelineTree tubeCentreline(const TubeShape& shape);

}  // namespace endovascular_sim::vessel
