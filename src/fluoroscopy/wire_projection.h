#pragma once

#include <cstdint>
#include <vector>

#include "fluoroscopy/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** What X-rays see of a wire: a chain of mitred solid cylinders, edge j from node j to node j + 1. Edges that
 * are one straight even cylinder may be taken for one. A hollow shaft is two: a solid one, and its lumen with what the
 * wall's material would have added there taken away again. */
struct XRayWire
{
  std::vector<Eigen::Vector3d> nodes;  ///< patient frame [m]
  std::vector<double> radius;          ///< at the nodes; an edge is a cylinder of the mean of its two [m]
  /** Per edge: linear attenuation coefficient of the material less that of what it displaces [1/m]. */
  std::vector<double> attenuation;
};

/** How a wire changes the image: the pixels that it touches, in the order in which it first touches them. */
struct WireShadow
{
  std::vector<std::uint32_t> pixels;  ///< row·N + column
  std::vector<double> transmission;   ///< factor on the pixel's signal, the mean over the pixel's area [1]
};

/** Projects a wire, keeping its work space from frame to frame.
 *
 *  In each touched pixel 89 rays are cast at the points of a Fibonacci lattice, whose projections on both image axes
 *  are 89 evenly spaced values, so that a wire thinner than a pixel keeps its integrated attenuation wherever it lies
 *  between the pixels. Along a ray s + t·d the chord in the cylinder (axis a through p, radius r) is
 *
 *      t = (d·p⊥ ± √(A r² − (d·(a×p))²)) / A,   A = |d|² − (d·a)²,   p⊥ = p − (p·a) a,
 *
 *  cut by the planes that bisect the angle to the neighbouring edges, so that edges neither overlap nor leave gaps.
 *  The signal is averaged as exp(−Σ μ·chord), the intensity, not the length. */
class WireProjection
{
public:
  /** @param wires all at once; where they overlap, their attenuations add up
   *  @throws InputError when a wire's arrays do not fit together or hold numbers that are not finite */
  void project(const XRayGeometry& geometry, const std::vector<XRayWire>& wires, WireShadow& shadow);

private:
  struct Offsets;
  struct Edge;
  class Footprint;
  class Chords;

  void addWire(const XRayGeometry& geometry, const Offsets& offsets, const XRayWire& wire);
  void addEdge(const XRayGeometry& geometry, const Offsets& offsets, const Edge& edge);
  float* samplesOf(std::uint32_t pixel);

  std::vector<std::int32_t> slot_;     // per pixel: index among the touched pixels, −1 when untouched
  std::vector<std::uint32_t> pixels_;  // touched pixels
  std::vector<float> optical_depth_;   // per touched pixel and sample [1]
};

}  // namespace endovascular_sim::fluoroscopy
