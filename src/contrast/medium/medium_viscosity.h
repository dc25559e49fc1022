#pragma once

namespace endovascular_sim::contrast
{

/** Viscosity at 37 °C of a contrast medium [Pa·s]. Its logarithm is linear between water, 0.69 mPa·s, and iohexol with
 *  140, 180, 240, 300 and 350 mgI/ml, 1.5, 2.0, 3.4, 6.3 and 10.4 mPa·s (Omnipaque, prescribing information), and
 * beyond.
 *  @param concentration of iodine [kg/m³] */
double mediumViscosity(double concentration);

}  // namespace endovascular_sim::contrast
