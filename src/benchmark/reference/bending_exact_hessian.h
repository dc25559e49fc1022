#pragma once

#include <Eigen/Core>

#include "rod/model/bending.h"

namespace endovascular_sim::benchmark
{

/** Exact Hessian blocks of ½|κb − c|² by both edges, c constant: the Gauss–Newton part and the curvature of κb along
 *  the strain κb − c. Indefinite at bent states: for statics and stability analysis, not for time stepping. */
struct BendingExactHessian : rod::BendingHessian
{
  /** @param rest c, the rest curvature binormal at fixed twist angles [1]
   *  @param scale factor on all blocks */
  BendingExactHessian(const rod::CurvatureBinormal& kb, const Eigen::Vector3d& rest, double scale)
    : BendingHessian(kb, scale)
  {
    // r·κb = N/D with r = κb − c held, N = 2 r·(e×g), D = |ē||ḡ| + e·g: second derivatives of the quotient.
    const Eigen::Vector3d& e = kb.edge;
    const Eigen::Vector3d& g = kb.next_edge;
    const Eigen::Vector3d r = kb.value - rest;
    const double d = kb.inverse_denominator;
    const double quotient = r.dot(kb.value);
    const Eigen::Vector3d by_e = (2.0 * d) * g.cross(r);
    const Eigen::Vector3d by_g = (2.0 * d) * r.cross(e);
    const Eigen::Matrix3d ee = (by_e - (quotient * d) * g) * (d * g).transpose();
    const Eigen::Matrix3d gg = (by_g - (quotient * d) * e) * (d * e).transpose();
    before_before -= scale * (ee + ee.transpose());
    after_after -= scale * (gg + gg.transpose());
    Eigen::Matrix3d cross;
    cross << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
    before_after -= scale * (2.0 * d * cross + d * (by_e * e.transpose() + g * by_g.transpose()) +
                             quotient * d * Eigen::Matrix3d::Identity() - (2.0 * quotient * d * d) * g * e.transpose());
  }
};

/** Bending energy at one node, ½ w |κb − c|² with w = EI over the Voronoi length [J]. */
inline double bendingEnergy(const rod::CurvatureBinormal& kb, const Eigen::Vector3d& rest, double weight)
{
  return 0.5 * weight * (kb.value - rest).squaredNorm();
}

}  // namespace endovascular_sim::benchmark
