#pragma once

#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::rod
{

/** Part of a wire with constant rest curvature. */
struct CurvedPart
{
  double begin = 0.0;                                   ///< arc length [m]
  double end = 0.0;                                     ///< [m]
  Eigen::Vector2d curvature = Eigen::Vector2d::Zero();  ///< components in the material frame [1/m]
  double bending_stiffness = 0.0;                       ///< EI [N·m²]
};

/** Integrated curvature, 2 tan(angle/2), of a turning angle [1]. */
Eigen::Vector2d integratedCurvature(const Eigen::Vector2d& angle);

/** Turning angle of an integrated curvature [rad]. */
Eigen::Vector2d turningAngle(const Eigen::Vector2d& curvature);

/** Hat function of a node: 1 at the node, 0 at its neighbours and beyond, linear on both edges. On the first edge it is
 *  that of the cells, 1 up to the middle: the first node does not bend, and a clamp acts at the middle. Its integral is
 *  the length of the node's cell.
 *  @param position arc length of all nodes, ascending [m] */
double hatOf(const std::vector<double>& position, int node, double arc_length);

/** Transition along the wire at the end of a straight hold. Rest curvature acts beyond it, and before it the wire is
 *  held straight. The acting share a rises linearly from 0 to 1 over the transition's width. */
struct Mouth
{
  double arc_length = 0.0;  ///< of the middle [m]
  double half_width = 0.0;  ///< positive [m]

  double begin() const { return arc_length - half_width; }
  double end() const { return arc_length + half_width; }
  double share(double at) const;
};

/** Turning angle at rest of a node: the integral of rest curvature times the node's hat function [rad]. */
Eigen::Vector2d restAngle(const std::vector<CurvedPart>& parts, const std::vector<double>& position, int node);

/** The same times the acting share. Its derivative by the mouth's arc length is continuous. */
Eigen::Vector2d restAngle(const std::vector<CurvedPart>& parts, const std::vector<double>& position, int node,
                          const Mouth& mouth);

/** Minus the derivative of that by the mouth's arc length [rad/m]. */
Eigen::Vector2d restAngleSlope(const std::vector<CurvedPart>& parts, const std::vector<double>& position, int node,
                               const Mouth& mouth);

/** Integral of a node's hat function times the acting share [m]. */
double hatBeyond(const std::vector<double>& position, int node, const Mouth& mouth);

/** Energy of the parts as far as they are held straight: ∫ ½ EI |κ̄|² (1 − a) ds [J]. */
double straightEnergy(const std::vector<CurvedPart>& parts, const Mouth& mouth);

/** Derivative of straightEnergy() by the mouth's arc length [N]. */
double straightEnergySlope(const std::vector<CurvedPart>& parts, const Mouth& mouth);

}  // namespace endovascular_sim::rod
