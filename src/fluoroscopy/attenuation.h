#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/quantity.h"

namespace endovascular_sim::fluoroscopy
{

/** Mass attenuation coefficients and densities, read from config/xray/attenuation.yaml. */
class AttenuationTable
{
public:
  /** Reads and checks a table.
   *  @throws InputError naming file, key and remedy */
  static AttenuationTable load(const std::string& file);

  /** Linear attenuation coefficient μ = (μ/ρ)·ρ [1/m] of a material of the table.
   *  @param energy photon energy [keV]
   *  @throws InputError for an unknown material or an energy outside of the table */
  double linear(const std::string& material, double energy) const;

  /** Linear attenuation coefficient of blood with iodinated contrast medium, μ_blood + c·(μ/ρ)_iodine [1/m].
   *  @param iodine concentration c [mgI/ml]
   *  @param energy photon energy [keV] */
  double contrast(double iodine, double energy) const;

  /** Mass attenuation coefficient μ/ρ [m²/kg] by log-log interpolation. Two entries of equal energy form an absorption
   *  edge. */
  double mass(const std::string& material, double energy) const;

  /** Unusual values of the file, each with file, key and likely unit. */
  const std::vector<std::string>& warnings() const { return warnings_; }

private:
  struct Material
  {
    double density = 0.0;        ///< [kg/m³]
    std::vector<double> energy;  ///< increasing; an absorption edge is listed twice [keV]
    std::vector<double> mass;    ///< mass attenuation coefficient at each energy [m²/kg]
  };

  const Material& find(const std::string& material) const;
  /** Warns of an unusual value.
   *  @throws InputError for an impossible value */
  void judge(const std::string& key, const Quantity& quantity, double value);

  std::string file_;
  std::map<std::string, Material> materials_;
  std::vector<std::string> warnings_;
};

}  // namespace endovascular_sim::fluoroscopy
