#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::rod
{

/** Part of a wire with constant rest curvature. */
struct CurvedPart
{
  double begin = 0.0;  ///< arc length [m]
  double end = 0.0;    ///< [m]
  Eigen::Vector2d curvature = Eigen::Vector2d::Zero();  ///< components in the material frame [1/m]
  double bending_stiffness = 0.0;                       ///< EI [N·m²]
};

/** Integrated curvature, 2 tan(angle/2), of a turning angle [1]. */
Eigen::Vector2d integratedCurvature(const Eigen::Vector2d& angle);

/** Turning angle of an integrated curvature [rad]. */
Eigen::Vector2d turningAngle(const Eigen::Vector2d& curvature);

/** Hat function of a node: 1 at the node, 0 at its neighbours and beyond, linear on both edges. Its integral is the
 *  length of the node's cell.
 *  @param position arc length of all nodes, ascending [m] */
double hatOf(const std::vector<double>& position, int node, double arc_length);

/** Turning angle at rest of a node: the integral of rest curvature times the node's hat function, from an arc length on
 *  [rad]. It is a smooth function of that arc length, whose derivative is continuous. */
Eigen::Vector2d restAngle(const std::vector<CurvedPart>& parts, const std::vector<double>& position, int node,
                          double from = -std::numeric_limits<double>::infinity());

/** Integral of a node's hat function from an arc length on [m]. */
double hatBeyond(const std::vector<double>& position, int node, double from);

/** Rest curvature at an arc length [1/m]. */
Eigen::Vector2d restCurvatureAt(const std::vector<CurvedPart>& parts, double arc_length);

/** Energy of the parts before an arc length when they are held straight: ∫ ½ EI |κ̄|² ds [J]. */
double straightEnergy(const std::vector<CurvedPart>& parts, double up_to);

/** Derivative of straightEnergy() by the arc length [N]. */
double straightEnergyPerLength(const std::vector<CurvedPart>& parts, double arc_length);

}  // namespace endovascular_sim::rod
