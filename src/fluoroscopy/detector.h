#pragma once

#include <cstdint>

namespace endovascular_sim::fluoroscopy
{

/** From intensity to grey values. Intensity is relative: 1 behind the tissue slab on the central ray, without vessel
 *  and wire, which is where the automatic exposure control holds the detector.
 *
 *  image_raw is linear in intensity: half of full scale at 1, saturated at 2 (little or no tissue).
 *
 *  image is for eyes: logarithmic, with a fixed window, and with the range of the vessel compressed as angiography
 *  systems do, so that a thin wire keeps its contrast inside a contrast-filled aorta. With the optical depths
 *  δ = −ln(intensity) of the background and δ_w of the wire,
 *
 *      grey = 255 · (δ₁ − c(δ) − δ_w) / (δ₁ − δ₀),   c(δ) = w·(1 − exp(−δ/w)) for δ > 0, else δ,
 *
 *  δ₀ = −0.5 (white), δ₁ = 2.2 (black), w = 1.2: tissue is 208, a 4 mm vessel with 150 mgI/ml 172, a large aorta 95 and
 *  more, a 0.36 mm nitinol wire 20 less than what is around it, a platinum tip black. */
struct Detector
{
  static constexpr double kBackgroundSignal = 32768.0;  ///< of image_raw at relative intensity 1

  /** Detector signal of image_raw [1]. */
  static std::uint16_t signal(double intensity);

  /** Grey value of image [1].
   *  @param background relative intensity without the wire
   *  @param wire factor of the wire on it */
  static std::uint8_t grey(double background, double wire);
};

}  // namespace endovascular_sim::fluoroscopy
