#pragma once

#include <array>
#include <vector>

#include "fluoroscopy/beam/beam.h"
#include "fluoroscopy/beam/material_library.h"

namespace endovascular_sim::fluoroscopy
{

/** Areal densities along a ray [kg/m²]. */
struct ArealDensities
{
  double tissue = 0.0;
  double bone = 0.0;
  double iodine = 0.0;
};

/** Response of the detector behind a patient. */
struct Response
{
  float log_signal = 0.0F;       ///< natural logarithm of the signal Σ N η E [keV/(m²·mAs) at 1 m]
  float variance_weight = 0.0F;  ///< Σ N η E² / Σ N η E: variance of the signal per signal [keV]
  float steel_slope = 0.0F;      ///< effective mass attenuation coefficient of a thin sheet of steel [m²/kg]
};

/** Table of the detector's response over areal densities of soft tissue, bone and iodine, integrated over bins of 1
 * keV.
 *
 *  Nodes are equidistant for tissue, and at squares of equidistant numbers for bone and iodine. Interpolation is linear
 * in each direction, and is continued linearly beyond the last node. Its error is below 0.2 % of the signal within the
 * table (docs/XRAY_IMAGES.md, "Beam"). */
class SignalTable
{
public:
  static constexpr int kTissueNodes = 81;
  static constexpr int kBoneNodes = 57;
  static constexpr int kIodineNodes = 97;
  static constexpr double kTissueMax = 640.0;  ///< [kg/m²]
  static constexpr double kBoneMax = 160.0;    ///< [kg/m²]
  static constexpr double kIodineMax = 12.0;   ///< [kg/m²]

  /** @throws InputError for a library without soft_tissue, cortical_bone, iodine or steel */
  SignalTable(const Beam& beam, const MaterialLibrary& library);

  /** Interpolated response. */
  Response at(const ArealDensities& densities) const;

  /** Response by direct integration over the spectrum; the reference of at(). */
  Response integrate(const ArealDensities& densities) const;

private:
  using Exponentials = std::vector<std::array<float, kEnergies>>;

  void fill(const Exponentials& tissue, const Exponentials& bone, const Exponentials& iodine);

  Spectrum signal_;
  EnergyTable tissue_, bone_, iodine_, steel_;
  std::vector<std::array<float, 4>> nodes_;  ///< log_signal, variance_weight, steel_slope, padding
};

}  // namespace endovascular_sim::fluoroscopy
