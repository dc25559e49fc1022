#pragma once

#include <algorithm>
#include <cmath>

namespace endovascular_sim::contrast
{

/** Viscosity of a mixture of contrast medium and blood, relative to that of the blood: (µ_c/µ_b)^φ (Arrhenius 1887).
 *
 *  The viscosity of iohexol with 140, 180, 240, 300 and 350 mgI/ml, 1.5, 2.0, 3.4, 6.3 and 10.4 mPa·s at 37 °C
 *  (Omnipaque, prescribing information), is that of its mixtures with water within 40 %; a mean weighted by volumes
 *  gives up to three times as much.
 *  @param share φ of the medium in the volume [1], limited to 0 to 1
 *  @param medium µ_c [Pa·s]
 *  @param blood µ_b [Pa·s], positive */
inline double mixedViscosityRatio(double share, double medium, double blood)
{
  return std::exp(std::clamp(share, 0.0, 1.0) * std::log(medium / blood));
}

}  // namespace endovascular_sim::contrast
