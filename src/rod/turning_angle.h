#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::rod
{

/** g(d) = φ/sin φ with φ = acos d, and its first two derivatives by d. */
struct AngleOverSine
{
  double value, first, second;

  explicit AngleOverSine(double d)
  {
    // (1 − d²) g′ = d g − 1 gives g = Σ a_k y^k with y = 1 − d, a_0 = 1, a_k = a_{k−1} k/(2k + 1).
    const double y = 1.0 - d;
    if (y > 0.1)
    {
      const double square = 1.0 - d * d;
      value = std::acos(d) / std::sqrt(square);
      first = (d * value - 1.0) / square;
      second = (value + 3.0 * d * first) / square;
      return;
    }
    const int terms = y < 0.004 ? 7 : 14;  // the series' ratio is y/2
    value = first = second = 0.0;
    for (int k = terms; k >= 0; --k)
    {
      second = second * y + 2.0 * first;
      first = first * y + value;
      value = value * y + kSeries[k];
    }
    first = -first;  // by d, not by y
  }

private:
  static constexpr double kSeries[15] = {1.0,
                                         1.0 / 3.0,
                                         2.0 / 15.0,
                                         2.0 / 35.0,
                                         8.0 / 315.0,
                                         8.0 / 693.0,
                                         16.0 / 3003.0,
                                         16.0 / 6435.0,
                                         128.0 / 109395.0,
                                         128.0 / 230945.0,
                                         256.0 / 969969.0,
                                         256.0 / 2028117.0,
                                         1024.0 / 16900975.0,
                                         1024.0 / 35102025.0,
                                         2048.0 / 145422675.0};
};

/** Turning angle vector between two directions: along e×g, as long as the angle between them [rad]. */
struct TurningAngle
{
  /** The cosine goes no lower than this (a turn of 168°): at a fold the angle has no direction. */
  static constexpr double kFolded = -0.98;

  Eigen::Vector3d before, after;         ///< unit tangents u, v
  double inverse_before, inverse_after;  ///< of the edges' lengths [1/m]
  Eigen::Vector3d cross;                 ///< u × v
  AngleOverSine ratio;                   ///< of the angle between them
  Eigen::Vector3d value;                 ///< Φ [rad]
  Eigen::Matrix3d by_before, by_after;   ///< ∂Φ/∂e, ∂Φ/∂g [rad/m]

  TurningAngle(const Eigen::Vector3d& e, const Eigen::Vector3d& g)
    : inverse_before(1.0 / e.norm()),
      inverse_after(1.0 / g.norm()),
      ratio(std::max(kFolded, (e * inverse_before).dot(g * inverse_after)))
  {
    before = e * inverse_before;
    after = g * inverse_after;
    cross = before.cross(after);
    value = ratio.value * cross;
    // ∂Φ/∂u = −g[v]× + g′ c vᵀ, ∂Φ/∂v = g[u]× + g′ c uᵀ, then projected across the edge.
    by_before.noalias() = (ratio.first * cross) * after.transpose();
    addCross(by_before, -ratio.value, after);
    by_before -= (by_before * before).eval() * before.transpose();
    by_before *= inverse_before;
    by_after.noalias() = (ratio.first * cross) * before.transpose();
    addCross(by_after, ratio.value, before);
    by_after -= (by_after * after).eval() * after.transpose();
    by_after *= inverse_after;
  }

  /** m += factor·[w]×. */
  static void addCross(Eigen::Matrix3d& m, double factor, const Eigen::Vector3d& w)
  {
    m(0, 1) -= factor * w.z();
    m(0, 2) += factor * w.y();
    m(1, 0) += factor * w.z();
    m(1, 2) -= factor * w.x();
    m(2, 0) -= factor * w.y();
    m(2, 1) += factor * w.x();
  }
};

/** Second derivatives of a function of a direction u = e/|e| by e [∂²/∂e²], from those by u.
 *  @param inverse 1/|e|
 *  @param gradient, hessian by u, u taken as free */
inline Eigen::Matrix3d hessianByEdge(const Eigen::Vector3d& u, double inverse, const Eigen::Vector3d& gradient,
                                     const Eigen::Matrix3d& hessian)
{
  const double along = u.dot(gradient);
  const Eigen::Vector3d across = gradient - along * u;
  const Eigen::Vector3d hu = hessian * u;
  const Eigen::Vector3d w = hu - (0.5 * u.dot(hu)) * u + across;
  Eigen::Matrix3d result = hessian;
  result.noalias() -= w * u.transpose();
  result.noalias() -= u * w.transpose();
  result.noalias() += (along * u) * u.transpose();
  result.diagonal().array() -= along;
  return (inverse * inverse) * result;
}

/** Exact second derivatives of m·Φ by the edges before and after the node. */
struct TurningHessian
{
  Eigen::Matrix3d before_before, before_after, after_after;

  TurningHessian(const TurningAngle& phi, const Eigen::Vector3d& m)
  {
    const Eigen::Vector3d& u = phi.before;
    const Eigen::Vector3d& v = phi.after;
    const double mc = m.dot(phi.cross);
    const double g = phi.ratio.value;
    const double g1 = phi.ratio.first;
    const double g2 = phi.ratio.second;
    const Eigen::Vector3d vm = v.cross(m);
    const Eigen::Vector3d mu = m.cross(u);
    const Eigen::Vector3d left = g1 * vm + (0.5 * mc * g2) * v;
    const Eigen::Vector3d right = g1 * mu + (0.5 * mc * g2) * u;
    Eigen::Matrix3d h = left * v.transpose();
    h += h.transpose().eval();
    before_before = hessianByEdge(u, phi.inverse_before, g * vm + (mc * g1) * v, h);
    h.noalias() = right * u.transpose();
    h += h.transpose().eval();
    after_after = hessianByEdge(v, phi.inverse_after, g * mu + (mc * g1) * u, h);
    h.noalias() = left * u.transpose();
    h.noalias() += v * right.transpose();
    h.diagonal().array() += mc * g1;
    TurningAngle::addCross(h, -g, m);
    h -= u * (u.transpose() * h).eval();
    h -= (h * v).eval() * v.transpose();
    before_after = (phi.inverse_before * phi.inverse_after) * h;
  }
};

}  // namespace endovascular_sim::rod
