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

}  // namespace endovascular_sim::rod
