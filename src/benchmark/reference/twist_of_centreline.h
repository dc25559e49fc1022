#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::benchmark
{

/** Derivatives of the twist at a node by its edges e (before) and g (after), whose material frames follow them by
 *  parallel transport in time: ∂m/∂e = κb/(2|e|), ∂m/∂g = κb/(2|g|) (Bergou et al. 2010, eq. 7). The actual lengths in
 *  κb make the derivatives exact for stretched edges.
 *
 *  The second derivatives are symmetrised. The twist of a single node depends on the path by the holonomy of its edges,
 *  but these parts cancel between neighbours: the sum over a wire with held ends, or over a ring, is exact. */
struct TwistOfCentreline
{
  Eigen::Vector3d by_before;      ///< ∂m/∂e [1/m]
  Eigen::Vector3d by_after;       ///< ∂m/∂g [1/m]
  Eigen::Matrix3d before_before;  ///< ∂²m/∂e² [1/m²]
  Eigen::Matrix3d before_after;   ///< ∂²m/∂e∂g [1/m²]
  Eigen::Matrix3d after_after;    ///< ∂²m/∂g² [1/m²]

  TwistOfCentreline(const Eigen::Vector3d& e, const Eigen::Vector3d& g)
  {
    const double before = e.norm();
    const double after = g.norm();
    const Eigen::Vector3d t = e / before;
    const Eigen::Vector3d u = g / after;
    const double chi = 1.0 + t.dot(u);
    const Eigen::Vector3d binormal = (2.0 / chi) * t.cross(u);
    const Eigen::Vector3d mean = (t + u) / chi;
    by_before = binormal / (2.0 * before);
    by_after = binormal / (2.0 * after);
    const Eigen::Matrix3d p = (-0.25 / (before * before)) * binormal * (t + mean).transpose();
    const Eigen::Matrix3d q = (-0.25 / (after * after)) * binormal * (u + mean).transpose();
    before_before = p + p.transpose();
    after_after = q + q.transpose();
    Eigen::Matrix3d cross;
    cross << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(), -t.y(), t.x(), 0.0;
    before_after = (0.5 / (before * after)) * ((2.0 / chi) * cross - binormal * mean.transpose());
  }
};

/** Parallel transport of a vector from tangent @p t to tangent @p u, both unit, u ≠ −t: the smallest rotation. */
inline Eigen::Vector3d parallelTransport(const Eigen::Vector3d& vector, const Eigen::Vector3d& t,
                                         const Eigen::Vector3d& u)
{
  const Eigen::Vector3d axis = t.cross(u);
  const double cosine = t.dot(u);
  return cosine * vector + axis.cross(vector) + (axis.dot(vector) / (1.0 + cosine)) * axis;
}

}  // namespace endovascular_sim::benchmark
