#pragma once

#include <vector>

#include "fluoroscopy/beam/beam.h"

namespace endovascular_sim::fluoroscopy
{

/** Signal and air kerma of a beam behind water, as functions of the areal density of the water. */
class WaterEquivalent
{
public:
  explicit WaterEquivalent(const Beam& beam);

  /** Areal density of water that gives a signal, between 0 and 600 [kg/m²].
   *  @param log_signal natural logarithm of the signal [keV/(m²·mAs) at 1 m] */
  double thickness(double log_signal) const;

  /** Logarithm of the signal behind water. */
  double logSignal(double thickness) const { return interpolate(log_signal_, thickness); }

  /** Air kerma at the detector per tube charge at 1 m, behind water and the grid [Gy/mAs]. */
  double detectorKerma(double thickness) const;

private:
  static double interpolate(const std::vector<double>& values, double thickness);

  std::vector<double> log_signal_, log_kerma_;  ///< at multiples of the step
};

}  // namespace endovascular_sim::fluoroscopy
