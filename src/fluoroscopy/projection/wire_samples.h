#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fluoroscopy/projection/wire_edge.h"

namespace endovascular_sim::fluoroscopy
{

/** Mean transmission of any set of wire edges over a pixel, by 89 rays at the points of a Fibonacci lattice, whose
 * projections on both image axes are equidistant. The chord of a ray s + t·d in a cylinder (axis a through p, radius r)
 * is
 *
 *      t = (d·p⊥ ± √(A r² − (d·(a×p))²)) / A,   A = |d|² − (d·a)²,   p⊥ = p − (p·a) a,
 *
 *  clipped by the bisecting planes to the adjacent edges, so that edges neither overlap nor leave gaps. */
class WireSamples
{
public:
  static constexpr std::size_t kSamples = 89;  ///< rays per pixel: Fibonacci number F(11)
  static constexpr std::size_t kPadded = 96;   ///< rays, padded to a multiple of the SIMD width

  /** @param focal_length SID / pixel size [pixel] */
  explicit WireSamples(double focal_length);

  /** Removes all edges. */
  void clear();

  /** Adds the chords of an edge.
   *  @param ray central ray of the pixel, with z = 1 */
  void add(const WireEdge& edge, const Eigen::Vector3d& ray);

  /** Mean transmission over the pixel [1]. */
  double transmission(const DeviceCoefficients& coefficients) const;

private:
  using Rays = std::array<float, kPadded>;

  Rays x_{}, y_{};          ///< offsets of the rays from the central ray; the padding is not evaluated
  Rays steel_{}, water_{};  ///< areal densities [kg/m²]
};

}  // namespace endovascular_sim::fluoroscopy
