#pragma once

#include <map>
#include <string>
#include <vector>

namespace endovascular_sim::fluoroscopy
{

/** Compounds of a mixture with their mass fractions [1]. */
using Composition = std::map<std::string, double>;

/** Mass attenuation coefficient μ/ρ of a mixture [m²/kg], total with coherent scattering, from xraylib.
 *  @param energy photon energy [keV]
 *  @throws InputError for a compound that xraylib does not know */
double massAttenuation(const Composition& composition, double energy);

/** Mass energy-absorption coefficient μ_en/ρ of a mixture [m²/kg], from xraylib. */
double massEnergyAbsorption(const Composition& composition, double energy);

/** Compositions and densities of materials, read from config/xray/materials.yaml. */
class MaterialLibrary
{
public:
  /** Reads and checks a library.
   *  @throws InputError naming file, key and remedy */
  static MaterialLibrary load(const std::string& file);

  /** Density of a material [kg/m³].
   *  @throws InputError for an unknown material */
  double density(const std::string& material) const { return find(material).density; }

  /** Composition of a material.
   *  @throws InputError for an unknown material */
  const Composition& composition(const std::string& material) const { return find(material).composition; }

  /** Mass attenuation coefficient μ/ρ [m²/kg] at a photon energy [keV]. */
  double mass(const std::string& material, double energy) const;

  /** Linear attenuation coefficient μ = (μ/ρ)·ρ [1/m] at a photon energy [keV]. */
  double linear(const std::string& material, double energy) const;

  /** Linear attenuation coefficient of blood with iodinated contrast medium, μ_blood + c·(μ/ρ)_iodine [1/m].
   *  @param iodine concentration c [mgI/ml]
   *  @param energy photon energy [keV] */
  double contrast(double iodine, double energy) const;

  /** Unusual values of the file, each with file, key and likely unit. */
  const std::vector<std::string>& warnings() const { return warnings_; }

private:
  struct Material
  {
    double density = 0.0;  ///< [kg/m³]
    Composition composition;
  };

  const Material& find(const std::string& material) const;

  std::string file_;
  std::map<std::string, Material> materials_;
  std::vector<std::string> warnings_;
};

}  // namespace endovascular_sim::fluoroscopy
