#pragma once

#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::benchmark
{

/** Part of a rigid bore around one station. */
struct BoreStation
{
  double clearance = 0.0;                               ///< radius of the bore less that of the wire [m]
  double friction = 0.0;                                ///< coefficient [1]
  Eigen::Vector2d curvature = Eigen::Vector2d::Zero();  ///< of the axis in a Bishop frame, towards the centre [1/m]
};

/** Rigid bore. */
struct Bore
{
  double spacing = 0.0;  ///< of the stations [m]
  std::vector<BoreStation> stations;
  Eigen::Matrix3d end = Eigen::Matrix3d::Identity();  ///< rows: Bishop frame across the axis, tangent
};

/** Load on the far end of a wire. */
struct BoreEndLoad
{
  double along = 0.0;                                ///< towards the hand [N]
  Eigen::Vector2d across = Eigen::Vector2d::Zero();  ///< force in the Bishop frame [N]
  Eigen::Vector2d couple = Eigen::Vector2d::Zero();  ///< moment crossed with the tangent [N·m]
};

/** Bore along an axis through given points, from an arc length to another.
 *  @param points at least three; the curvature at the points is interpolated linearly
 *  @param begin, end arc lengths [m]
 *  @param spacing of the stations, which is rounded to a whole number of them [m]
 *  @param station clearance and friction of all stations */
Bore boreAlong(const std::vector<Eigen::Vector3d>& points, double begin, double end, double spacing,
               const BoreStation& station);

/** Force that pushes a wire through a rigid bore against a load on its far end, in static equilibrium.
 *
 *  The shift u of the wire across the axis, small against the radius of a bend, makes
 *
 *      ∫ ½ B |κ + u″|² − ½ C |u′|² + C κ·u + ½ k (|u| − c)₊² ds
 *
 *  stationary and stable. The compression C falls towards the far end by the friction: C′ = −μ k (|u| − c)₊. The wire
 * is clamped on the axis where the force acts; the load acts at the far end. In contrast to rod::BoreContact the
 * compression acts in |u′|² too: the wire buckles, and the ends and reversals of its helix are part of the solution.
 *
 *  The flow u̇ = −∂E/∂u is integrated implicitly to rest, with steps shorter than the growth of every unstable mode. The
 *  load grows from zero; the compression follows the flow.
 *  @param stiffness of the wire in bending [N·m²]
 *  @throws std::runtime_error unless the flow comes to rest */
double pushThroughBore(double stiffness, const Bore& bore, const BoreEndLoad& load);

}  // namespace endovascular_sim::benchmark
