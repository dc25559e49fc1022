#pragma once

#include "fluoroscopy/image/water_equivalent.h"

namespace endovascular_sim::fluoroscopy
{

/** Programme of the automatic brightness control. */
struct ExposureSettings
{
  double detector_dose = 30e-9;  ///< air kerma per frame at the detector behind the grid, without scatter [Gy]
  double rate = 15.0;            ///< frames per second [Hz]
  double max_air_kerma_rate = 88e-3 / 60.0;  ///< limit at the reference point [Gy/s]; 88 mGy/min: 21 CFR 1020.32
};

/** Automatic brightness control.
 *
 *  The mean signal of the measuring field gives the areal density w of the patient, as water. The tube charge per frame
 * gives the wanted dose at the detector behind w. It is limited by the air kerma rate at the reference point, 0.15 m
 * from the isocentre towards the source (IEC 60601-2-43). Beyond the limit the signal decreases and the relative noise
 * grows. The control has no memory, so that a frame does not depend on those before it. */
class ExposureControl
{
public:
  /** @throws InputError for settings that are not positive */
  ExposureControl(const Beam& beam, const ExposureSettings& settings);

  const ExposureSettings& settings() const { return settings_; }
  const WaterEquivalent& water() const { return water_; }

  /** Tube charge of a frame [mAs].
   *  @param log_signal logarithm of the mean signal in the measuring field [keV/(m²·mAs) at 1 m]
   *  @param source_to_detector SID [m]
   *  @param source_to_patient SOD [m] */
  double tubeCharge(double log_signal, double source_to_detector, double source_to_patient) const;

  /** Largest tube charge of a frame, at the limit of the air kerma rate [mAs]. */
  double largestCharge(double source_to_patient) const;

  /** Air kerma of a frame at the reference point [Gy]. */
  double referenceKerma(double tube_charge, double source_to_patient) const;

private:
  ExposureSettings settings_;
  WaterEquivalent water_;
  double entrance_kerma_;  ///< at 1 m [Gy/mAs]
};

}  // namespace endovascular_sim::fluoroscopy
