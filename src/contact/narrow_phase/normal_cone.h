#pragma once

#include <cmath>
#include <limits>

namespace endovascular_sim::contact
{

// Tolerances of the normal-cone test. A point has an edge or a vertex of the wall as a local minimum of the distance
// only inside the cone that the normals of the triangles around it span. Bounds and exact tests share these constants.

constexpr double kReflexAngle = 1e-4;  ///< rad: edges that bulge less are tested against the wire's nodes only
constexpr double kConeSlack = 1e-3;    ///< widening of the cone of an edge, relative to the distance
/** Widening of the cone of an edge close to the wire, relative to the reflex angle. A wire that lies along a facet
 *  also touches the facet's border. If that contact depended on the wire's exact direction, it would appear and
 *  disappear from pass to pass and the solver would oscillate. */
constexpr double kConeSlackOfAngle = 0.1;
constexpr double kSharp = 1.2;  ///< rad: cones wider than this are treated as unbounded

/** Lateral extent of a cone per height above its apex: the tangent of its half angle, infinite beyond kSharp.
 *  @param half_angle angle between the cone's axis and its surface [rad] */
inline double coneSlope(double half_angle)
{
  return half_angle > kSharp ? std::numeric_limits<double>::infinity() : std::tan(half_angle);
}

}  // namespace endovascular_sim::contact
