#pragma once

#include <cstdint>

namespace endovascular_sim::fluoroscopy
{

/** Response of the flat-panel detector: intensity to pixel values. Intensities are relative to the central ray behind
 *  the tissue slab, without vessel and wire. The automatic exposure control keeps the intensity of this reference ray
 * constant.
 *
 *  image_raw is linear in intensity: half of full scale at 1, saturated at 2 (little or no tissue).
 *
 *  image is the displayed image: logarithmic, with a fixed window and a compressed dynamic range of the background, as
 *  in angiography systems. A thin wire thereby retains its contrast inside a contrast-filled aorta. With the optical
 *  depths δ = −ln(intensity) of the background and δ_w of the wire,
 *
 *      grey = 255 · (δ₁ − c(δ) − δ_w) / (δ₁ − δ₀),   c(δ) = w·(1 − exp(−δ/w)) for δ > 0, else δ,
 *
 *  δ₀ = −0.5 (white), δ₁ = 2.2 (black), w = 1.2. Grey values: tissue 208; a 4 mm vessel with 150 mgI/ml 172; a large
 *  aorta 95 or more; a 0.36 mm nitinol wire 20 below its surroundings; a platinum tip 0. */
struct Detector
{
  static constexpr double kBackgroundSignal = 32768.0;  ///< signal of image_raw at relative intensity 1

  /** Pixel value of image_raw [1]. */
  static std::uint16_t signal(double intensity);

  /** Pixel value of image [1].
   *  @param background relative intensity without the wire
   *  @param wire transmission of the wire */
  static std::uint8_t grey(double background, double wire);
};

}  // namespace endovascular_sim::fluoroscopy
