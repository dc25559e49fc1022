#pragma once

#include <cstdint>
#include <vector>

#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** X-ray model of a wire: chain of solid cylinders with mitre joints; edge j joins nodes j and j + 1. Collinear edges
 *  of equal radius may be merged. A hollow shaft consists of two wires: a solid one, and its lumen with negative
 *  attenuation. */
struct XRayWire
{
  std::vector<Eigen::Vector3d> nodes;  ///< patient frame [m]
  std::vector<double> radius;          ///< radius at the nodes [m]; an edge has the mean radius of its nodes
  /** Per edge: linear attenuation coefficient of the material minus that of the displaced medium [1/m]. */
  std::vector<double> attenuation;
};

/** Shadow of wires in the image: affected pixels in the order of their first access. */
struct WireShadow
{
  std::vector<std::uint32_t> pixels;  ///< pixel index row·N + column
  std::vector<double> transmission;   ///< transmission averaged over the pixel's area [1]
};

/** Projection of wires onto the detector; work space is reused between frames.
 *
 *  Each affected pixel is sampled by 89 rays at the points of a Fibonacci lattice, whose projections on both image axes
 *  are equidistant. The integrated attenuation of a wire thinner than a pixel is thereby independent of its sub-pixel
 *  position. The chord of a ray s + t·d in a cylinder (axis a through p, radius r) is
 *
 *      t = (d·p⊥ ± √(A r² − (d·(a×p))²)) / A,   A = |d|² − (d·a)²,   p⊥ = p − (p·a) a,
 *
 *  clipped by the bisecting planes to the adjacent edges, so that edges neither overlap nor leave gaps. The average is
 *  taken over the intensity exp(−Σ μ·chord), not over the chord. */
class WireProjection
{
public:
  /** Projects all wires of a frame; the attenuations of overlapping wires add up.
   *  @throws InputError for a wire with arrays of inconsistent size or non-finite numbers */
  void project(const XRayGeometry& geometry, const std::vector<XRayWire>& wires, WireShadow& shadow);

private:
  struct Offsets;
  struct Edge;
  class Footprint;
  class Chords;

  void addWire(const XRayGeometry& geometry, const Offsets& offsets, const XRayWire& wire);
  void addEdge(const XRayGeometry& geometry, const Offsets& offsets, const Edge& edge);
  float* samplesOf(std::uint32_t pixel);

  std::vector<std::int32_t> slot_;     ///< per pixel: index in pixels_, −1 for an unaffected pixel
  std::vector<std::uint32_t> pixels_;  ///< affected pixels
  std::vector<float> optical_depth_;   ///< per affected pixel and sample [1]
};

}  // namespace endovascular_sim::fluoroscopy
