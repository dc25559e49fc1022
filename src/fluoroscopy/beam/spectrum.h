#pragma once

#include <array>
#include <cstddef>

#include "fluoroscopy/beam/material_library.h"

namespace endovascular_sim::fluoroscopy
{

constexpr std::size_t kEnergies = 151;    ///< bins of 1 keV; bin e covers e ± 0.5 keV
constexpr std::size_t kLowestEnergy = 5;  ///< photons of lower energy never reach a patient [keV]
constexpr double kCoulombPerMas = 1e-3;   ///< charge of 1 mAs [C]
constexpr double kJoulePerKev = 1.602176634e-16;

/** Value per photon energy: index e is the energy e [keV]. Values below kLowestEnergy are zero. */
using EnergyTable = std::array<double, kEnergies>;

/** Photons per bin, area and tube charge at 1 m from the source [1/(m²·mAs)]. */
using Spectrum = EnergyTable;

/** Mass attenuation coefficients of a mixture [m²/kg]. */
EnergyTable massAttenuationTable(const Composition& composition);

/** Spectrum behind a layer.
 *  @param mass mass attenuation coefficients of the layer [m²/kg]
 *  @param areal_density density times thickness of the layer [kg/m²] */
Spectrum filtered(const Spectrum& spectrum, const EnergyTable& mass, double areal_density);

/** Air kerma per tube charge at 1 m from the source [Gy/mAs], from the mass energy-absorption coefficients of dry air.
 */
double airKerma(const Spectrum& spectrum);

/** Half-value layer with respect to air kerma [m].
 *  @param composition material of the layer
 *  @param density density of the layer [kg/m³]
 *  @param fraction transmitted fraction of the air kerma; 0.5 for the first half-value layer */
double halfValueLayer(const Spectrum& spectrum, const Composition& composition, double density, double fraction = 0.5);

}  // namespace endovascular_sim::fluoroscopy
