#include "fluoroscopy/beam/beam.h"

#include <cmath>

#include "common/error.h"
#include "fluoroscopy/beam/tube_spectrum.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kAluminium = 2699.0;  // densities [kg/m³]
constexpr double kCopper = 8960.0;
constexpr double kCaesiumIodide = 4510.0;
constexpr double kAir = 1.205;
constexpr double kDistance = 1.0;          // path in air [m]
constexpr double kTableAndCover = 1.5e-3;  // of aluminium [m]
constexpr double kGrid = 0.7;              // primary transmission of the anti-scatter grid
constexpr double kScintillator = 550e-6;   // [m]
constexpr double kPacking = 0.8;           // of the columnar scintillator
constexpr double kMonoenergetic = 1e13;    // photons of a monoenergetic beam [1/(m²·mAs)]

/** Mass attenuation coefficients of the layers that every beam passes [m²/kg], computed once. */
struct Layers
{
  EnergyTable aluminium = massAttenuationTable({{"Al", 1.0}});
  EnergyTable copper = massAttenuationTable({{"Cu", 1.0}});
  EnergyTable air = massAttenuationTable({{"Air, Dry (near sea level)", 1.0}});
  EnergyTable scintillator = massAttenuationTable({{"CsI", 1.0}});
};

const Layers& layers()
{
  static const Layers kLayers;
  return kLayers;
}

void requireRange(const char* key, double value, double low, double high, const char* unit)
{
  if (!(value >= low && value <= high))
    throw InputError("X-ray beam", key,
                     "must lie between " + std::to_string(low) + " and " + std::to_string(high) + " " + unit);
}

Spectrum source(const BeamSettings& settings)
{
  if (!settings.energy)
    return tungstenSpectrum(settings.tube_voltage);
  Spectrum spectrum{};
  spectrum[static_cast<std::size_t>(std::lround(*settings.energy))] = kMonoenergetic;
  return spectrum;
}

}  // namespace

bool operator==(const BeamSettings& a, const BeamSettings& b)
{
  return a.tube_voltage == b.tube_voltage && a.aluminium == b.aluminium && a.copper == b.copper && a.energy == b.energy;
}

Beam::Beam(const BeamSettings& settings) : settings_(settings)
{
  requireRange("tube_voltage", settings.tube_voltage, 50.0, 125.0, "kV");
  requireRange("aluminium", settings.aluminium, 0.0, 0.02, "m");
  requireRange("copper", settings.copper, 0.0, 2e-3, "m");
  if (settings.energy)
    requireRange("energy", *settings.energy, 30.0, 125.0, "keV");
  const Layers& layer = layers();
  entrance_ = source(settings);
  entrance_ = filtered(entrance_, layer.aluminium, kAluminium * settings.aluminium);
  entrance_ = filtered(entrance_, layer.copper, kCopper * settings.copper);
  entrance_ = filtered(entrance_, layer.air, kAir * kDistance);
  detector_ = filtered(entrance_, layer.aluminium, kAluminium * kTableAndCover);
  for (std::size_t e = 0; e < kEnergies; ++e)
  {
    detector_[e] *= kGrid;
    absorption_[e] = 1.0 - std::exp(-layer.scintillator[e] * kCaesiumIodide * kPacking * kScintillator);
  }
}

Spectrum Beam::signal() const
{
  Spectrum result{};
  for (std::size_t e = kLowestEnergy; e < kEnergies; ++e)
    result[e] = detector_[e] * absorption_[e] * static_cast<double>(e);
  return result;
}

}  // namespace endovascular_sim::fluoroscopy
