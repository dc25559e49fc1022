#pragma once

#include <optional>

#include "fluoroscopy/image/water_equivalent.h"

namespace endovascular_sim::fluoroscopy
{

/** Programme of the automatic brightness control. */
struct ExposureSettings
{
  double detector_dose = 30e-9;  ///< air kerma per frame at the detector behind the grid, without scatter [Gy]
  double rate = 15.0;            ///< frames per second [Hz]
  double time_constant = 0.4;    ///< of the control [s]
  double max_air_kerma_rate = 88e-3 / 60.0;  ///< limit at the reference point [Gy/s]; 88 mGy/min: 21 CFR 1020.32
};

/** Automatic brightness control.
 *
 *  The mean signal of the measuring field gives the areal density w of the patient, as water. w follows the measurement
 * with the time constant τ: w ← w + (1 − exp(−Δt/τ)) (w_measured − w). The tube charge per frame gives the wanted dose
 * at the detector behind w. It is limited by the air kerma rate at the reference point, 0.15 m from the isocentre
 * towards the source (IEC 60601-2-43). Beyond the limit the signal decreases and the relative noise grows. */
class ExposureControl
{
public:
  /** @throws InputError for settings that are not positive */
  ExposureControl(const Beam& beam, const ExposureSettings& settings);

  const ExposureSettings& settings() const { return settings_; }
  const WaterEquivalent& water() const { return water_; }

  /** Tube charge of the next frame [mAs]. The first frame starts with the measured thickness.
   *  @param log_signal logarithm of the mean signal in the measuring field [keV/(m²·mAs) at 1 m]
   *  @param source_to_detector SID [m]
   *  @param source_to_patient SOD [m] */
  double next(double log_signal, double source_to_detector, double source_to_patient);

  /** Forgets earlier frames. */
  void reset() { thickness_.reset(); }

  /** Areal density of the patient as water that the control assumes [kg/m²]. */
  double thickness() const { return thickness_.value_or(0.0); }

  /** True if the last frame was limited by the air kerma rate. */
  bool limited() const { return limited_; }

  /** Air kerma of a frame at the reference point [Gy]. */
  double referenceKerma(double tube_charge, double source_to_patient) const;

private:
  ExposureSettings settings_;
  WaterEquivalent water_;
  double entrance_kerma_;  ///< at 1 m [Gy/mAs]
  std::optional<double> thickness_;
  bool limited_ = false;
};

}  // namespace endovascular_sim::fluoroscopy
