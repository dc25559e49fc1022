#pragma once

#include <vector>

#include "fluoroscopy/image/coarse_image.h"

namespace endovascular_sim::fluoroscopy
{

/** Rectangular field of the collimator, centred on the detector.
 *
 *  The share t of a pixel inside of the field is the product of one factor per column and one per row. The factors are
 * 1 inside and 0 outside, with a smooth transition of kPenumbra. The blades transmit kTransmission of the primary
 * signal. A side of 0, or at least as long as that of the detector, is open. */
class Collimator
{
public:
  static constexpr double kTransmission = 2e-3;  ///< of the blades [1] (chosen; 0.1 to 0.5 % is usual)
  static constexpr double kPenumbra = 3e-3;      ///< width of the transition at the detector [m]

  /** @param pixels pixels per side of the image
   *  @param detector_width width of the detector [m]
   *  @param width,height of the field at the detector [m] */
  Collimator(int pixels, double detector_width, double width, double height);

  bool isOpen() const { return open_; }

  /** Side of the square with the area of the field [m]. */
  double side() const { return side_; }

  /** Share of a pixel inside of the field, 0 to 1. */
  float share(int row, int column) const
  {
    return rows_[static_cast<std::size_t>(row)] * columns_[static_cast<std::size_t>(column)];
  }

  /** Transmission of the field and of the blades at a pixel, as in apply() [1]. */
  float transmission(int row, int column) const
  {
    constexpr auto kBlades = static_cast<float>(kTransmission);
    return open_ ? 1.0F
                 : kBlades + (1.0F - kBlades) * rows_[static_cast<std::size_t>(row)] *
                                 columns_[static_cast<std::size_t>(column)];
  }

  /** Attenuates the primary signal behind the blades. */
  void apply(std::vector<float>& signal) const;

private:
  bool open_;
  double side_;
  std::vector<float> columns_, rows_;
};

/** Extends an image from the bins that lie inside of the field to all bins, by a normalised convolution.
 *  @param sigma standard deviation of the convolution [pixel] */
CoarseImage extended(const CoarseImage& image, const Collimator& collimator, int pixels, double sigma);

}  // namespace endovascular_sim::fluoroscopy
