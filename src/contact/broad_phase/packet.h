#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::contact
{

// What of the wall is near, looked at four at a time in single precision, as seen from an origin close by. Such a look
// only leaves out what cannot matter: it is generous by kQuadSlack, which is more than rounding adds for places up to
// 0.1 m from the origin and a wall of up to 1 m.

constexpr int kQuad = 4;
using Packet4f = Eigen::Array<float, kQuad, 1>;

constexpr float kQuadSlack = 1e-6F;                               ///< m
constexpr float kQuadOpen = 1e30F;                                ///< a slope that is not bounded
constexpr float kNever = std::numeric_limits<float>::infinity();  ///< of clearances [m]

/** A vector per lane. */
struct QuadVectors
{
  Packet4f x = Packet4f::Zero();
  Packet4f y = Packet4f::Zero();
  Packet4f z = Packet4f::Zero();

  EIGEN_STRONG_INLINE Packet4f dot(const Eigen::Vector3f& v) const { return x * v.x() + y * v.y() + z * v.z(); }
  EIGEN_STRONG_INLINE Packet4f dot(const QuadVectors& v) const { return x * v.x + y * v.y + z * v.z; }
  /** From these places to another one. */
  EIGEN_STRONG_INLINE QuadVectors to(const Eigen::Vector3f& v) const { return {v.x() - x, v.y() - y, v.z() - z}; }

  void set(int lane, const Eigen::Vector3d& v)
  {
    x[lane] = static_cast<float>(v.x());
    y[lane] = static_cast<float>(v.y());
    z[lane] = static_cast<float>(v.z());
  }
};

/** Visits the index of whatever is not hidden from a place, in their order. */
template <class Quad, class Visit>
EIGEN_STRONG_INLINE void forEachInSight(const std::vector<Quad>& quads, const typename Quad::Place& place,
                                        Visit&& visit)
{
  for (const Quad& quad : quads)
  {
    const Packet4f hidden = quad.hidden(place);
    for (int lane = 0; lane < kQuad; ++lane)
      if (hidden[lane] <= 0.0F)
        visit(quad.index(lane));
  }
}

}  // namespace endovascular_sim::contact
