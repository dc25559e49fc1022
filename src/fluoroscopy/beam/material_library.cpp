#include "fluoroscopy/beam/material_library.h"

#include <xraylib/xraylib.h>

#include <cmath>

#include "common/error.h"
#include "common/quantities.h"
#include "yaml/reader.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kSquareCentimetrePerGram = 0.1;    // [m²/kg]
constexpr double kGramPerCubicCentimetre = 1000.0;  // [kg/m³]
constexpr double kFractionTolerance = 1e-3;         // of the sum of mass fractions

/** Sum of mass fraction times coefficient over a mixture [m²/kg]. */
double mixture(const Composition& composition, double energy, double (*coefficient)(const char*, double, xrl_error**))
{
  double sum = 0.0;
  for (const auto& [compound, fraction] : composition)
  {
    xrl_error* error = nullptr;
    const double value = coefficient(compound.c_str(), energy, &error);
    if (error != nullptr)
    {
      const std::string reason = error->message;
      xrl_error_free(error);
      throw InputError("xraylib", compound,
                       "has no attenuation at " + std::to_string(energy) + " keV (" + reason +
                           "); use a chemical formula or a name of xraylib's NIST list");
    }
    sum += fraction * value;
  }
  return sum * kSquareCentimetrePerGram;
}

/** Key `composition`: a compound, or a map from compounds to mass fractions. */
Composition readComposition(yaml::Fields& fields)
{
  const std::string key = "composition";
  Composition composition;
  if (!fields.hasMap(key))
  {
    std::string compound;
    fields.text(key, compound, yaml::Need::kRequired);
    composition[compound] = 1.0;
  }
  else
    fields.map(key,
               [&](yaml::Fields& parts)
               {
                 double sum = 0.0;
                 for (const std::string& compound : parts.keys())
                 {
                   parts.number(compound, composition[compound], quantities::kNumber, yaml::Range::positive());
                   sum += composition[compound];
                 }
                 if (std::abs(sum - 1.0) > kFractionTolerance)
                   parts.reject("",
                                "has mass fractions with the sum " + std::to_string(sum) + "; they must add up to 1");
               });
  try
  {
    massAttenuation(composition, 60.0);
  }
  catch (const InputError& error)
  {
    fields.reject(key, error.what());
  }
  return composition;
}

}  // namespace

double massAttenuation(const Composition& composition, double energy)
{
  return mixture(composition, energy, CS_Total_CP);
}

double massEnergyAbsorption(const Composition& composition, double energy)
{
  return mixture(composition, energy, CS_Energy_CP);
}

MaterialLibrary MaterialLibrary::load(const std::string& file)
{
  const yaml::Node root = yaml::readTree(file, "give a file of materials as config/xray/materials.yaml");
  yaml::ReadingReport report;
  yaml::Reader reader(root, &report);
  MaterialLibrary library;
  library.file_ = file;
  for (const std::string& name : reader.keys())
    reader.map(name,
               [&](yaml::Fields& fields)
               {
                 Material& material = library.materials_[name];
                 fields.number("density", material.density, quantities::kMaterialDensity, yaml::Range::positive(),
                               yaml::Need::kRequired);
                 material.density *= kGramPerCubicCentimetre;
                 material.composition = readComposition(fields);
               });
  library.warnings_ = report.warnings;
  return library;
}

const MaterialLibrary::Material& MaterialLibrary::find(const std::string& material) const
{
  const auto found = materials_.find(material);
  if (found == materials_.end())
    throw InputError(file_, material, "missing; add density and composition of this material");
  return found->second;
}

double MaterialLibrary::mass(const std::string& material, double energy) const
{
  return massAttenuation(find(material).composition, energy);
}

double MaterialLibrary::linear(const std::string& material, double energy) const
{
  return mass(material, energy) * density(material);
}

double MaterialLibrary::contrast(double iodine, double energy) const
{
  return linear("blood", energy) + iodine * mass("iodine", energy);  // 1 mg/ml = 1 kg/m³
}

}  // namespace endovascular_sim::fluoroscopy
