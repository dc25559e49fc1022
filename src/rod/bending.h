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
  /** The denominator goes no lower than this share of |ē||ḡ| (a turn of 163°): edges that fold back onto each other
   * would make it zero, or negative. */
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
    const Eigen::Vector3d ws = w * g;
    const Eigen::Vector3d p = (0.5 * (kk - 4.0)) * g - 2.0 * g.cross(k);
    const Eigen::Vector3d q = (0.5 * (kk - 4.0)) * e + 2.0 * e.cross(k);
    // (∂κb/∂e)ᵀ(∂κb/∂e) = (4|g|²I − 4ggᵀ − 2(g×k)gᵀ − 2g(g×k)ᵀ + |k|²ggᵀ)/D²
    before_before.noalias() = p * ws.transpose();
    before_before += before_before.transpose().eval();
    before_before.diagonal().array() += 4.0 * w * g.squaredNorm();
    // (∂κb/∂g)ᵀ(∂κb/∂g) = (4|e|²I − 4eeᵀ + 2(e×k)eᵀ + 2e(e×k)ᵀ + |k|²eeᵀ)/D²
    const Eigen::Vector3d we = w * e;
    after_after.noalias() = q * we.transpose();
    after_after += after_after.transpose().eval();
    after_after.diagonal().array() += 4.0 * w * e.squaredNorm();
    // (∂κb/∂e)ᵀ(∂κb/∂g) = (4egᵀ − 4(g·e)I − 2(g×k)eᵀ + 2g(e×k)ᵀ + |k|²geᵀ)/D²
    before_after.noalias() = (4.0 * e) * ws.transpose();
    before_after.noalias() += (kk * g - 2.0 * g.cross(k)) * we.transpose();
    before_after.noalias() += (2.0 * ws) * e.cross(k).transpose();
    before_after.diagonal().array() -= 4.0 * w * g.dot(e);
  }
};

}  // namespace endovascular_sim::rod
