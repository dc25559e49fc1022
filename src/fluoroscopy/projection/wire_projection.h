#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fluoroscopy/projection/wire.h"
#include "fluoroscopy/projection/wire_edge.h"
#include "fluoroscopy/projection/wire_samples.h"
#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Shadow of wires in the image: affected pixels in the order of their first access. */
struct WireShadow
{
  std::vector<std::uint32_t> pixels;  ///< pixel index row·N + column
  std::vector<double> transmission;   ///< transmission averaged over the pixel's area [1]
};

/** Projection of wires onto the detector; work space is reused between frames.
 *
 *  A pixel that one wire crosses, straight and with one profile over the whole chord, is the integral of the radial
 * profile over the pixel's trapezoidal width (profileTransmission()). Every other pixel is sampled by rays
 * (WireSamples): at bends, ends, changes of the profile, crossings, loops and where the wire runs along the ray. The
 * average is taken over the intensity exp(−D), not over the chord. */
class WireProjection
{
public:
  /** Coefficients of the optical depth at a pixel. */
  using Coefficients = std::function<DeviceCoefficients(std::uint32_t pixel)>;

  /** Projects all wires of a frame; the areal densities of overlapping wires add up.
   *  @throws InputError for a wire with arrays of inconsistent size or non-finite numbers */
  void project(const XRayGeometry& geometry, const std::vector<XRayWire>& wires, const Coefficients& coefficients,
               WireShadow& shadow);

private:
  /** Edge in the list of a pixel. */
  struct Entry
  {
    std::int32_t edge;
    std::int32_t next;  ///< index of the next entry of the pixel, −1 at the end
  };

  void collect(const XRayGeometry& geometry);
  double transmission(const XRayGeometry& geometry, std::uint32_t pixel, const DeviceCoefficients& coefficients,
                      WireSamples& samples) const;
  int edgeOfStraightPart(const Eigen::Vector3d& ray, std::int32_t entry, double half_diagonal) const;

  std::vector<WireEdge> edges_;
  std::vector<std::int32_t> head_;     ///< per pixel: first entry, −1 for an unaffected pixel
  std::vector<std::uint32_t> pixels_;  ///< affected pixels
  std::vector<Entry> entries_;
};

}  // namespace endovascular_sim::fluoroscopy
