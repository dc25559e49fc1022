#pragma once

#include <algorithm>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::rod
{

/** Curvature binormal at the node between edges e and g (Bergou et al. 2008, eq. 1, rest lengths in the denominator):
 *  κb = 2 e×g / (|ē||ḡ| + e·g), an integrated quantity [1]; |κb| = 2 tan(turning angle / 2) for unstretched edges. */
struct CurvatureBinormal
{
  /** Lower bound of the denominator over |ē||ḡ|, reached at a turn of 163°. Edges that fold back onto each other would
   *  make the denominator zero or negative. */
  static constexpr double kFolded = 0.02;

  Eigen::Vector3d edge;        ///< e, the edge before the node [m]
  Eigen::Vector3d next_edge;   ///< g, the edge after it [m]
  double inverse_denominator;  ///< 1/(|ē||ḡ| + e·g) [1/m²]
  Eigen::Vector3d value;       ///< κb [1]

  CurvatureBinormal(const Eigen::Vector3d& e, const Eigen::Vector3d& g, double rest_product)
    : edge(e),
      next_edge(g),
      inverse_denominator(1.0 / std::max(rest_product + e.dot(g), kFolded * rest_product)),
      value((2.0 * inverse_denominator) * e.cross(g))
  {
  }

  /** Jᵀr for the edge before the node: (∂κb/∂e)ᵀ r. */
  Eigen::Vector3d transposeBefore(const Eigen::Vector3d& r) const
  {
    return inverse_denominator * (2.0 * next_edge.cross(r) - value.dot(r) * next_edge);
  }

  /** Jᵀr for the edge after the node: (∂κb/∂g)ᵀ r. */
  Eigen::Vector3d transposeAfter(const Eigen::Vector3d& r) const
  {
    return inverse_denominator * (-2.0 * edge.cross(r) - value.dot(r) * edge);
  }
};

/** Gauss–Newton blocks JᵀJ of ½|κb − c|² by the edges e (before) and g (after) the node. */
struct BendingHessian
{
  Eigen::Matrix3d before_before;
  Eigen::Matrix3d before_after;
  Eigen::Matrix3d after_after;

  /** @param scale factor on all blocks */
  BendingHessian(const CurvatureBinormal& kb, double scale)
  {
    const Eigen::Vector3d& e = kb.edge;
    const Eigen::Vector3d& g = kb.next_edge;
    const Eigen::Vector3d& k = kb.value;
    const double w = scale * kb.inverse_denominator * kb.inverse_denominator;
    const double kk = k.squaredNorm();
    const Eigen::Vector3d gk = g.cross(k);
    const Eigen::Vector3d ek = e.cross(k);
    const Eigen::Vector3d p = (0.5 * w * (kk - 4.0)) * g - (2.0 * w) * gk;
    const Eigen::Vector3d q = (0.5 * w * (kk - 4.0)) * e + (2.0 * w) * ek;
    const Eigen::Vector3d u = (w * kk) * g - (2.0 * w) * gk;
    const Eigen::Vector3d wg = (2.0 * w) * g;
    // Entry by entry: assembly spends most of its time here.
    //   (∂κb/∂e)ᵀ(∂κb/∂e) = (4|g|²I − 4ggᵀ − 2(g×k)gᵀ − 2g(g×k)ᵀ + |k|²ggᵀ)/D²
    //   (∂κb/∂g)ᵀ(∂κb/∂g) = (4|e|²I − 4eeᵀ + 2(e×k)eᵀ + 2e(e×k)ᵀ + |k|²eeᵀ)/D²
    //   (∂κb/∂e)ᵀ(∂κb/∂g) = (4egᵀ − 4(g·e)I − 2(g×k)eᵀ + 2g(e×k)ᵀ + |k|²geᵀ)/D²
#pragma GCC unroll 3
    for (int col = 0; col < 3; ++col)
    {
#pragma GCC unroll 3
      for (int line = 0; line < 3; ++line)
      {
        before_before(line, col) = p[line] * g[col] + g[line] * p[col];
        after_after(line, col) = q[line] * e[col] + e[line] * q[col];
        before_after(line, col) = 2.0 * (e[line] * wg[col]) + u[line] * e[col] + wg[line] * ek[col];
      }
    }
    const double gg4 = 4.0 * w * g.squaredNorm();
    const double ee4 = 4.0 * w * e.squaredNorm();
    const double ge4 = 4.0 * w * g.dot(e);
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis)
    {
      before_before(axis, axis) += gg4;
      after_after(axis, axis) += ee4;
      before_after(axis, axis) -= ge4;
    }
  }
};

/** Exact Hessian blocks of ½|κb − c|² by both edges, c constant: the Gauss–Newton part and the curvature of κb along
 *  the strain κb − c. Indefinite at bent states: for statics and stability analysis, not for time stepping. */
struct BendingExactHessian : BendingHessian
{
  /** @param rest c, the rest curvature binormal at fixed twist angles [1]
   *  @param scale factor on all blocks */
  BendingExactHessian(const CurvatureBinormal& kb, const Eigen::Vector3d& rest, double scale)
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
inline double bendingEnergy(const CurvatureBinormal& kb, const Eigen::Vector3d& rest, double weight)
{
  return 0.5 * weight * (kb.value - rest).squaredNorm();
}

}  // namespace endovascular_sim::rod
