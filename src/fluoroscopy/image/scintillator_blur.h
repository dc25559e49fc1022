#pragma once

#include <vector>

namespace endovascular_sim::fluoroscopy
{

/** Spread of light in the scintillator and integration over pixels, as a separable kernel.
 *
 *  The modulation transfer function of the scintillator is 1/(1 + H f²), H = 0.45 mm²: 0.69, 0.36 and 0.20 at 1, 2 and
 *  3/mm, typical of 550 µm CsI. Its line spread function is (π/√H) exp(−2π|x|/√H). Photons fall uniformly into a pixel,
 * so that tap k is the line spread function weighted with a triangle of the width of two pixels at k. */
class ScintillatorBlur
{
public:
  /** @param pitch width of a pixel at the detector [m] */
  explicit ScintillatorBlur(double pitch);

  /** Taps 0, 1, … of the symmetric kernel. */
  const std::vector<float>& taps() const { return taps_; }

  /** Modulation transfer function of the kernel along an axis.
   *  @param frequency [1/pixel] */
  double transfer(double frequency) const;

  /** Blurs a square image in place; beyond the edges the edge pixel is repeated. */
  void apply(int pixels, std::vector<float>& image);

private:
  std::vector<float> taps_;
  std::vector<float> rows_, line_;  ///< work space
};

}  // namespace endovascular_sim::fluoroscopy
