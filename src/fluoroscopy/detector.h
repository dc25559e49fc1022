#pragma once

#include <cstdint>

namespace endovascular_sim::fluoroscopy
{

/** From intensity to grey values. Intensity is relative: 1 behind the tissue slab on the central ray, without vessel
 *  and wire, which is where the automatic exposure control holds the detector.
 *
 *  image_raw: linear in intensity, half of full scale at 1, saturated at 2 (little or no tissue).
 *  image: for eyes. With the optical depth against the tissue δ = −ln(intensity), the grey value is
 *
 *      255 · (1 − ln(1 + (δ − δ₀)/w) / ln(1 + (δ₁ − δ₀)/w)),   δ₀ = −0.1, δ₁ = 5, w = 1.5,
 *
 *  a fixed window, logarithmic once more so that a wire of δ = 0.3 shows both beside a vessel and inside
 *  a contrast-filled aorta of δ = 3, as the display curves of angiography systems do. */
struct Detector
{
  static constexpr double kBackgroundSignal = 32768.0;  ///< of image_raw at relative intensity 1

  /** Detector signal of image_raw [1]. */
  static std::uint16_t signal(double intensity);

  /** Grey value of image [1]. */
  static std::uint8_t grey(double intensity);
};

}  // namespace endovascular_sim::fluoroscopy
