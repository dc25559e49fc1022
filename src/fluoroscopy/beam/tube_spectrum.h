#pragma once

#include "fluoroscopy/beam/spectrum.h"

namespace endovascular_sim::fluoroscopy
{

constexpr double kClinicalAnodeAngle = 0.20943951;  ///< 12°, usual for angiography tubes [rad]

/** Spectrum of an unfiltered tungsten anode after the semi-empirical model of D. M. Tucker, G. T. Barnes and
 *  D. P. Chakraborty, Med. Phys. 18 (1991) 211.
 *
 *  Bremsstrahlung of electrons of initial energy T₀, produced at depths given by the Thomson–Whiddington law and
 *  attenuated by the tungsten above,
 *
 *      N(E) = s · α r_e² Z² N_A/(A E) · ∫_E^T₀ B(E/T) (T + m c²)/T · F(E, T) / S(T) dT,
 *      F = exp(−μ_W(E) (T₀² − T²)/(ρ C sin θ)),
 *
 *  with the mass stopping power S, and four K lines with the yield k·A_K (T₀/E_K − 1)^n at depths of parabolic density.
 * The polynomial B, S, A_K and n are the paper's; C is the paper's table times c. Three constants are fitted: c = 1.15,
 * s and k (docs/XRAY_IMAGES.md, "Beam").
 *
 *  @param voltage constant tube voltage, 20 to 150 [kV]
 *  @param anode_angle angle θ between anode surface and central ray [rad] */
Spectrum tungstenSpectrum(double voltage, double anode_angle = kClinicalAnodeAngle);

}  // namespace endovascular_sim::fluoroscopy
