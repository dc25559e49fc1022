#pragma once

#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::benchmark
{

/** Wire in a rigid bore. */
struct BoreWire
{
  double stiffness = 0.0;  ///< in bending [N·m²]
  double clearance = 0.0;  ///< radius of the bore less that of the wire [m]
  double friction = 0.0;   ///< coefficient [1]
};

/** Curvature of a bore's axis. */
struct BoreAxis
{
  double spacing = 0.0;                    ///< of the stations [m]
  std::vector<Eigen::Vector2d> curvature;  ///< in a Bishop frame at the stations, towards the centre [1/m]
};

/** Axis through given points, from an arc length to another.
 *  @param points at least three; the curvature at the points is interpolated linearly
 *  @param begin, end arc lengths [m]
 *  @param spacing of the stations, which is rounded to a whole number of them [m] */
BoreAxis boreAxis(const std::vector<Eigen::Vector3d>& points, double begin, double end, double spacing);

/** Force that pushes a wire through a rigid bore against a load on its far end, in static equilibrium.
 *
 *  The shift u of the wire across the axis, small against the radius of a bend, makes
 *
 *      ∫ ½ B |κ + u″|² − ½ C |u′|² + C κ·u + ½ k (|u| − c)₊² ds
 *
 *  stationary and stable. The compression C falls towards the far end by the friction: C′ = −μ k (|u| − c)₊. The wire
 * is clamped on the axis where the force acts, and free at the far end. In contrast to rod::BoreContact the compression
 *  acts in |u′|² too: the wire buckles, and the ends and reversals of its helix are part of the solution.
 *
 *  The flow u̇ = −∂E/∂u is integrated implicitly to rest, with steps shorter than the growth of every unstable mode. The
 *  load grows from zero; the compression follows the flow.
 *  @param load on the far end [N]
 *  @throws std::runtime_error unless the flow comes to rest */
double pushThroughBore(const BoreWire& wire, const BoreAxis& axis, double load);

}  // namespace endovascular_sim::benchmark
