#pragma once

#include <cstdint>
#include <vector>

#include "fluoroscopy/image/coarse_image.h"
#include "fluoroscopy/image/scintillator_blur.h"
#include "fluoroscopy/image/water_equivalent.h"

namespace endovascular_sim::fluoroscopy
{

/** Exposure of one frame. */
struct FrameExposure
{
  double tube_charge = 0.0;  ///< [mAs]
  std::uint64_t seed = 0;
  std::uint64_t frame = 0;  ///< counter of frames; selects the noise
};

/** Formation of the detector image: scatter, quantum noise, blur of the scintillator, read-out noise, 16 bits.
 *
 *  Quantum noise is Gaussian. With the signal S [keV] of a pixel, primary and scattered, its variance is W·S, where the
 *  weight W = Σ N η E²/Σ N η E is that of the primary beam at the pixel. The detector is flat-field corrected: inverse
 *  square law and obliquity are removed from signal and noise.
 *
 *  image_raw is linear: kCountsPerGray times the air kerma behind 20 cm of water that gives the same signal. */
class DetectorImage
{
public:
  static constexpr double kCountsPerGray = 64e9;  ///< 64 per nGy: saturation at 1.02 µGy
  static constexpr double kReadOutNoise =
      6.0;  ///< standard deviation [count]; quantum noise of 0.09 nGy in a pixel of 0.6 mm

  /** @param pixels pixels per side
   *  @param width width of the detector [m]
   *  @param source_to_detector SID [m]
   *  @param field side of the irradiated square at the detector [m] */
  DetectorImage(int pixels, double width, double source_to_detector, const WaterEquivalent& water, double field);

  /** Forms the image.
   *  @param primary primary signal [keV/(m²·mAs) at 1 m]; overwritten
   *  @param mean mean of @p primary per bin
   *  @param weight variance weight per pixel [keV] */
  void form(const FrameExposure& exposure, std::vector<float>& primary, const CoarseImage& mean,
            const std::vector<float>& weight, std::vector<std::uint16_t>& raw);

  /** Mean of the noise-free signal per bin, with scatter [count]. */
  const CoarseImage& counts() const { return counts_; }

  const ScintillatorBlur& blur() const { return blur_; }

private:
  int pixels_;
  double width_;
  double field_;   ///< side of the irradiated square at the detector [m]
  double quanta_;  ///< signal of a pixel [keV] per signal at 1 m and tube charge
  double gain_;    ///< counts per signal at 1 m and tube charge
  WaterEquivalent water_;
  ScintillatorBlur blur_;
  CoarseImage scatter_, counts_;
  std::vector<float> read_out_;  ///< standard normal numbers of the read-out noise
};

}  // namespace endovascular_sim::fluoroscopy
