#pragma once

#include <optional>

#include "fluoroscopy/beam/spectrum.h"

namespace endovascular_sim::fluoroscopy
{

/** Technique factors of the tube. */
struct BeamSettings
{
  double tube_voltage = 80.0;    ///< 50 to 125 [kV]
  double aluminium = 2.5e-3;     ///< total filtration with aluminium [m]
  double copper = 0.2e-3;        ///< additional filtration with copper [m]
  std::optional<double> energy;  ///< if set: a monoenergetic beam of this energy instead of a tube [keV]
};

bool operator==(const BeamSettings& a, const BeamSettings& b);
inline bool operator!=(const BeamSettings& a, const BeamSettings& b)
{
  return !(a == b);
}

/** Beam from the tube to the detector, without patient.
 *
 *  Table top and detector cover are 1.5 mm of aluminium. The anti-scatter grid transmits 70 % of the primary photons.
 * The detector is a scintillator of 550 µm CsI with a packing fraction of 0.8; it absorbs the fraction η(E) = 1 −
 * exp(−μ_CsI·0.8·550 µm) of the photons, and its signal is the sum of their energies. */
class Beam
{
public:
  /** @throws InputError for a voltage, energy or filtration out of range */
  explicit Beam(const BeamSettings& settings);

  const BeamSettings& settings() const { return settings_; }

  /** Photons at the patient's entrance, behind the filtration and 1 m of air. */
  const Spectrum& entrance() const { return entrance_; }

  /** Photons that reach the scintillator without patient. */
  const Spectrum& detector() const { return detector_; }

  /** Fraction η of photons absorbed by the scintillator [1]. */
  const EnergyTable& absorption() const { return absorption_; }

  /** Signal of the detector per area and tube charge at 1 m from the source without patient, per bin: N·η·E
   *  [keV/(m²·mAs)]. */
  Spectrum signal() const;

private:
  BeamSettings settings_;
  Spectrum entrance_{};
  Spectrum detector_{};
  EnergyTable absorption_{};
};

}  // namespace endovascular_sim::fluoroscopy
