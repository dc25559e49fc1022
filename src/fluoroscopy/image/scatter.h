#pragma once

#include "fluoroscopy/image/coarse_image.h"
#include "fluoroscopy/image/water_equivalent.h"

namespace endovascular_sim::fluoroscopy
{

/** Ratio of scattered to primary signal behind the anti-scatter grid [1],
 *
 *      SPR = g · 2.6 · (w / 200 kg/m²)^1.3 · (1 − exp(−b / 0.16 m)),   g = 0.17,
 *
 *  for the areal density w of the patient as water and the side b of the square field at the detector. 2.6 is the order
 * of the ratio without grid behind 20 cm of water in a large field at 80 kV, g the ratio of the grid's transmissions of
 * scatter (0.12) and primary photons (0.7). The form is phenomenological; it has not been fitted to a measurement. */
double scatterToPrimary(double thickness, double field);

/** Replaces the mean primary signal of each bin by the scattered signal: primary times SPR, spread by a Gaussian of 30
 *  mm.
 *  @param width width of the detector [m]
 *  @param field side of the irradiated square at the detector [m] */
void scatter(CoarseImage& image, const WaterEquivalent& water, double width, int pixels, double field);

}  // namespace endovascular_sim::fluoroscopy
