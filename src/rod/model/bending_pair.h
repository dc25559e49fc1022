#pragma once

#include <Eigen/Core>

#include "rod/model/bending.h"

namespace endovascular_sim::rod
{

/** Packet of two doubles (SIMD); plain SSE2, so the bits are the same on every machine. */
typedef double Pair __attribute__((vector_size(16)));  // NOLINT: the form in which compilers take the attribute

/** Packet of two vectors in space. */
struct PairVector
{
  Pair x, y, z;

  static PairVector of(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
  {
    return {Pair{a.x(), b.x()}, Pair{a.y(), b.y()}, Pair{a.z(), b.z()}};
  }
  Pair dot(const PairVector& o) const { return x * o.x + y * o.y + z * o.z; }
  PairVector cross(const PairVector& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  friend PairVector operator+(const PairVector& a, const PairVector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend PairVector operator-(const PairVector& a, const PairVector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend PairVector operator*(const Pair& s, const PairVector& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend PairVector operator*(double s, const PairVector& a) { return {s * a.x, s * a.y, s * a.z}; }
};

/** Input of the bending of two nodes; e is the edge before each node, g the edge after it. */
struct BendingPairInput
{
  PairVector e, g;     ///< [m]
  Pair rest_product;   ///< |ē||ḡ| [m²]
  Pair weight;         ///< factor on ½|κb − c|²
  PairVector rest;     ///< c, rest curvature binormal in space [1]
  Pair torque_before;  ///< gradient of the twist by the edge before, divided by −κb
  Pair torque_after;   ///< gradient of the twist by the edge after, divided by κb
};

/** Gradient and Gauss–Newton blocks of the bending of two nodes: CurvatureBinormal and BendingHessian, two at a time.
 *  Assembly spends most of its time here. */
struct BendingPair
{
  Pair before_before[3][3];  ///< lower triangle, [line][col]
  Pair before_after[3][3];
  Pair after_after[3][3];  ///< lower triangle
  Pair proximal[3];        ///< gradient by the position of the node before
  Pair distal[3];          ///< gradient by the position of the node after

  explicit BendingPair(const BendingPairInput& in)
  {
    const PairVector& e = in.e;
    const PairVector& g = in.g;
    const Pair least = CurvatureBinormal::kFolded * in.rest_product;
    const Pair product = in.rest_product + e.dot(g);
    const Pair inverse = 1.0 / (product > least ? product : least);
    const PairVector k = (2.0 * inverse) * e.cross(g);
    const PairVector r = k - in.rest;
    const Pair scale = in.weight * inverse;
    const Pair kr = k.dot(r);
    const PairVector gradient_e = scale * (2.0 * g.cross(r) - kr * g);
    const PairVector gradient_g = scale * (-2.0 * e.cross(r) - kr * e);
    store(-1.0 * gradient_e - in.torque_before * k, proximal);
    store(gradient_g + in.torque_after * k, distal);
    const Pair w = scale * inverse;
    const Pair kk = k.dot(k);
    const PairVector gk = g.cross(k);
    const PairVector ek = e.cross(k);
    const Pair half = 0.5 * w * (kk - 4.0);
    const Pair twice = 2.0 * w;
    Pair ea[3], ga[3], pa[3], qa[3], ua[3], wg[3], eka[3];
    store(e, ea);
    store(g, ga);
    store(half * g - twice * gk, pa);
    store(half * e + twice * ek, qa);
    store((w * kk) * g - twice * gk, ua);
    store(twice * g, wg);
    store(ek, eka);
    const Pair gg4 = 2.0 * twice * g.dot(g);
    const Pair ee4 = 2.0 * twice * e.dot(e);
    const Pair ge4 = 2.0 * twice * g.dot(e);
#pragma GCC unroll 3
    for (int line = 0; line < 3; ++line)
    {
#pragma GCC unroll 3
      for (int col = 0; col < 3; ++col)
      {
        before_after[line][col] = 2.0 * (ea[line] * wg[col]) + ua[line] * ea[col] + wg[line] * eka[col];
        if (col > line)
          continue;
        before_before[line][col] = pa[line] * ga[col] + ga[line] * pa[col];
        after_after[line][col] = qa[line] * ea[col] + ea[line] * qa[col];
      }
      before_before[line][line] += gg4;
      after_after[line][line] += ee4;
      before_after[line][line] -= ge4;
    }
  }

private:
  static void store(const PairVector& v, Pair (&to)[3])
  {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  }
};

}  // namespace endovascular_sim::rod
