#pragma once

#include "fluoroscopy/projection/wire_edge.h"

namespace endovascular_sim::fluoroscopy
{

/** Cylinder of infinite length seen by one pixel.
 *
 *  The distance between a ray d = (x, y, 1) and the axis is |o|/√A with o = d·(a×p), a linear function of the image
 *  coordinates. The pixel's area has a trapezoidal density over o. */
struct PixelView
{
  /** @param ray central ray of the pixel, with z = 1 */
  PixelView(const WireEdge& edge, const Eigen::Vector3d& ray, double focal_length);

  float off;         ///< o at the centre of the pixel [m]
  float wide, flat;  ///< half widths of the lower and the upper base of the trapezoid [m]
  float a;           ///< A
  float norm;        ///< |d|
};

/** Mean transmission over a pixel that an unclipped edge crosses [1]: the integral of exp(−D) over o with 16 points.
 * The points are dense towards the rim of the cylinder, where the chord has an infinite slope. */
double profileTransmission(const WireProfile& profile, double radius, const PixelView& view,
                           const DeviceCoefficients& coefficients);

}  // namespace endovascular_sim::fluoroscopy
