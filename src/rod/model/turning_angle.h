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

/** Turning angle vector between two directions: along e×g, its length the angle between them [rad].
 *
 *  With u = e/|e|, v = g/|g|, c = u×v, d = u·v: Φ = g(d) c, and its derivatives are
 *  ∂Φ/∂e = (c aᵀ − g[v]×)/|e|, a = g′v − (g′d + g)u, and ∂Φ/∂g = (c bᵀ + g[u]×)/|g|, b = g′u − (g′d + g)v. */
struct TurningAngle
{
  /** Lower bound of the cosine, reached at a turn of 168°: at a fold the angle has no direction. */
  static constexpr double kFolded = -0.98;

  double inverse_before, inverse_after;  ///< inverses of the edges' lengths [1/m]
  Eigen::Vector3d before, after;         ///< unit tangents u, v
  double cosine;                         ///< d
  Eigen::Vector3d cross;                 ///< c
  AngleOverSine ratio;                   ///< g(d)
  Eigen::Vector3d along_before;          ///< a
  Eigen::Vector3d along_after;           ///< b
  Eigen::Vector3d value;                 ///< Φ [rad]

  TurningAngle(const Eigen::Vector3d& e, const Eigen::Vector3d& g)
    : inverse_before(1.0 / e.norm()),
      inverse_after(1.0 / g.norm()),
      before(inverse_before * e),
      after(inverse_after * g),
      cosine(std::max(kFolded, before.dot(after))),
      cross(before.cross(after)),
      ratio(cosine),
      along_before(ratio.first * after - (ratio.first * cosine + ratio.value) * before),
      along_after(ratio.first * before - (ratio.first * cosine + ratio.value) * after),
      value(ratio.value * cross)
  {
  }

  /** ∂Φ/∂e [rad/m]. */
  Eigen::Matrix3d byBefore() const
  {
    Eigen::Matrix3d block = cross * (inverse_before * along_before).transpose();
    addCross(block, -ratio.value * inverse_before, after);
    return block;
  }

  /** ∂Φ/∂g [rad/m]. */
  Eigen::Matrix3d byAfter() const
  {
    Eigen::Matrix3d block = cross * (inverse_after * along_after).transpose();
    addCross(block, ratio.value * inverse_after, before);
    return block;
  }

  /** (∂Φ/∂e)ᵀ m. */
  Eigen::Vector3d transposeBefore(const Eigen::Vector3d& m) const
  {
    return inverse_before * (ratio.value * after.cross(m) + cross.dot(m) * along_before);
  }

  /** (∂Φ/∂g)ᵀ m. */
  Eigen::Vector3d transposeAfter(const Eigen::Vector3d& m) const
  {
    return inverse_after * (cross.dot(m) * along_after - ratio.value * before.cross(m));
  }

  /** m += factor·[w]×. */
  static void addCross(Eigen::Matrix3d& m, double factor, const Eigen::Vector3d& w)
  {
    const Eigen::Vector3d f = factor * w;
    m(0, 1) -= f.z();
    m(0, 2) += f.y();
    m(1, 0) += f.z();
    m(1, 2) -= f.x();
    m(2, 0) -= f.y();
    m(2, 1) += f.x();
  }
};

/** scale·(p qᵀ + q pᵀ − r sᵀ − s rᵀ − shift·I). */
inline Eigen::Matrix3d symmetricBlock(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                                      const Eigen::Vector3d& s, double shift, double scale)
{
  Eigen::Matrix3d block;
  for (int col = 0; col < 3; ++col)
    for (int row = col; row < 3; ++row)
    {
      const double value = scale * (p[row] * q[col] + q[row] * p[col] - r[row] * s[col] - s[row] * r[col]);
      block(row, col) = value;
      block(col, row) = value;
    }
  block.diagonal().array() -= scale * shift;
  return block;
}

/** Second derivatives by e of a function of the direction u = e/|e|. Those by u, as if |u| were free, are p qᵀ + q pᵀ.
 *  @param inverse 1/|e|
 *  @param gradient by u */
inline Eigen::Matrix3d hessianByEdge(const Eigen::Vector3d& u, double inverse, const Eigen::Vector3d& gradient,
                                     const Eigen::Vector3d& p, const Eigen::Vector3d& q)
{
  // (P H P − (u·∇)P − (P∇)uᵀ − u(P∇)ᵀ)/|e|² with P = I − uuᵀ
  const double along = u.dot(gradient);
  const double up = u.dot(p);
  const double uq = u.dot(q);
  const Eigen::Vector3d w = gradient + uq * p + up * q - (up * uq + 1.5 * along) * u;
  return symmetricBlock(p, q, w, u, along, inverse * inverse);
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
    const double bend = 0.5 * mc * phi.ratio.second;
    const double a = mc * g1;
    const Eigen::Vector3d vm = v.cross(m);
    const Eigen::Vector3d mu = m.cross(u);
    // ∂²/∂u² = p vᵀ + v pᵀ, ∂²/∂v² = q uᵀ + u qᵀ, ∂²/∂u∂v = p uᵀ + v qᵀ + a I − g[m]×
    const Eigen::Vector3d p = g1 * vm + bend * v;
    const Eigen::Vector3d q = g1 * mu + bend * u;
    before_before = hessianByEdge(u, phi.inverse_before, g * vm + a * v, p, v);
    after_after = hessianByEdge(v, phi.inverse_after, g * mu + a * u, q, u);
    const double d = u.dot(v);
    const double both = phi.inverse_before * phi.inverse_after;
    const Eigen::Vector3d p_across = p - u.dot(p) * u;
    const Eigen::Vector3d q_across = q - v.dot(q) * v;
    const Eigen::Vector3d u_across = both * (u - d * v);
    const Eigen::Vector3d v_across = both * (v - d * u);
    const Eigen::Vector3d right = both * ((a * d + g * u.dot(vm)) * v - a * u - g * mu);
    const Eigen::Vector3d left = both * (-g * vm - a * v);
    for (int col = 0; col < 3; ++col)
      for (int row = 0; row < 3; ++row)
        before_after(row, col) =
            p_across[row] * u_across[col] + v_across[row] * q_across[col] + u[row] * right[col] + left[row] * v[col];
    before_after.diagonal().array() += both * a;
    TurningAngle::addCross(before_after, -both * g, m);
  }
};

}  // namespace endovascular_sim::rod
