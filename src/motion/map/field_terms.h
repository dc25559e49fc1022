#pragma once

#include "motion/map/motion_field.h"

namespace endovascular_sim::motion
{

/** Numbers of a map in the order of their use, for loops over many points that the compiler makes wide. */
struct FieldTerms
{
  double centre[3], base[3], axis[3], shift[3];
  double linear[3][3];   ///< rows
  double twist;          ///< [rad/m]
  double turned[3][3];   ///< twist × matrix of the cross product with the axis
  double core_square;    ///< [m²]
  double inverse_width;  ///< 1/(reach² − core²) [1/m²]

  FieldTerms(const HeartFrame& frame, const MotionField& field)
    : twist(field.twist),
      core_square(frame.fade.core * frame.fade.core),
      inverse_width(1.0 / (frame.fade.reach * frame.fade.reach - core_square))
  {
    const Eigen::Vector3d a = frame.axis;
    for (int i = 0; i < 3; ++i)
    {
      centre[i] = frame.fade.centre[i], base[i] = frame.base[i], axis[i] = a[i], shift[i] = field.shift[i];
      for (int j = 0; j < 3; ++j)
        linear[i][j] = field.linear(i, j), turned[i][j] = 0.0;
    }
    turned[0][1] = -twist * a[2], turned[0][2] = twist * a[1], turned[1][0] = twist * a[2];
    turned[1][2] = -twist * a[0], turned[2][0] = -twist * a[1], turned[2][1] = twist * a[0];
  }
};

/** Weight, field and what their gradients need, at one point, or at several in the lanes of a vector type. */
template <typename Real>
struct FieldPoint
{
  Real weight;     ///< w
  Real slope;      ///< ∇w = slope · (X − centre) [1/m²]
  Real from[3];    ///< X − centre [m]
  Real along;      ///< a·p [m]
  Real across[3];  ///< twist · (a × p) [1]
  Real value[3];   ///< v [m]
};

/** Evaluates weight and field at X [m]. */
template <typename Real>
[[gnu::always_inline]] inline void evaluate(const FieldTerms& f, const Real (&x)[3], FieldPoint<Real>& at)
{
  Real p[3];
  for (int i = 0; i < 3; ++i)
  {
    at.from[i] = x[i] - f.centre[i];
    p[i] = x[i] - f.base[i];
  }
  const Real square = at.from[0] * at.from[0] + at.from[1] * at.from[1] + at.from[2] * at.from[2];
  const Real zero = square - square, one = zero + 1.0;
  Real t = (square - f.core_square) * f.inverse_width;
  t = t > zero ? t : zero;
  t = t < one ? t : one;
  at.weight = 1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t));
  const Real inner = t * (1.0 - t);
  at.slope = -60.0 * f.inverse_width * (inner * inner);
  at.along = f.axis[0] * p[0] + f.axis[1] * p[1] + f.axis[2] * p[2];
  for (int i = 0; i < 3; ++i)
  {
    at.across[i] = f.turned[i][(i + 1) % 3] * p[(i + 1) % 3] + f.turned[i][(i + 2) % 3] * p[(i + 2) % 3];
    at.value[i] =
        f.shift[i] + f.linear[i][0] * p[0] + f.linear[i][1] * p[1] + f.linear[i][2] * p[2] + at.along * at.across[i];
  }
}

/** Computes ∇φ from an evaluated point, with the component i of φ in row i. */
template <typename Real>
[[gnu::always_inline]] inline void differentiate(const FieldTerms& f, const FieldPoint<Real>& at,
                                                 Real (&gradient)[3][3])
{
  for (int j = 0; j < 3; ++j)
  {
    const Real fade = at.slope * at.from[j];
    for (int i = 0; i < 3; ++i)
    {
      Real field = f.linear[i][j] + at.across[i] * f.axis[j];
      if (i != j)
        field = field + at.along * f.turned[i][j];
      gradient[i][j] = at.value[i] * fade + at.weight * field;
    }
    gradient[j][j] = 1.0 + gradient[j][j];
  }
}

/** Newton step for φ(X) = x. @param target x [m]  @param x place X, which is improved [m] */
template <typename Real>
[[gnu::always_inline]] inline void newtonStep(const FieldTerms& f, const Real (&target)[3], Real (&x)[3])
{
  FieldPoint<Real> at;
  evaluate(f, x, at);
  Real g[3][3], rest[3], cofactor[3][3];
  differentiate(f, at, g);
  for (int i = 0; i < 3; ++i)
    rest[i] = x[i] + at.weight * at.value[i] - target[i];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      cofactor[i][j] = g[(i + 1) % 3][(j + 1) % 3] * g[(i + 2) % 3][(j + 2) % 3] -
                       g[(i + 1) % 3][(j + 2) % 3] * g[(i + 2) % 3][(j + 1) % 3];
  const Real inverse = 1.0 / (g[0][0] * cofactor[0][0] + g[0][1] * cofactor[0][1] + g[0][2] * cofactor[0][2]);
  for (int j = 0; j < 3; ++j)
    x[j] = x[j] - inverse * (cofactor[0][j] * rest[0] + cofactor[1][j] * rest[1] + cofactor[2][j] * rest[2]);
}

}  // namespace endovascular_sim::motion
