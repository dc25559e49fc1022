#include "fluoroscopy/beam/material_library.h"

#include <xraylib/xraylib.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <iterator>

#include "common/error.h"
#include "common/input_file.h"
#include "common/quantities.h"
#include "common/text/yaml_text.h"

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

double positiveNumber(const YAML::Node& node, const std::string& file, const std::string& key)
{
  double value = 0.0;
  if (!node || !YAML::convert<double>::decode(node, value) || !std::isfinite(value) || value <= 0.0)
    throw InputError(file, key, "must be a positive number");
  return value;
}

Composition readComposition(const YAML::Node& node, const std::string& file, const std::string& key)
{
  Composition composition;
  if (node && node.IsScalar())
    composition[node.as<std::string>()] = 1.0;
  else if (node && node.IsMap() && node.size() > 0)
  {
    double sum = 0.0;
    for (const auto& part : node)
    {
      const auto compound = part.first.as<std::string>();
      sum += composition[compound] = positiveNumber(part.second, file, key + "." + compound);
    }
    if (std::abs(sum - 1.0) > kFractionTolerance)
      throw InputError(file, key, "has mass fractions with the sum " + std::to_string(sum) + "; they must add up to 1");
  }
  else
    throw InputError(file, key, "must be a compound, or a map from compounds to mass fractions");
  try
  {
    massAttenuation(composition, 60.0);
  }
  catch (const InputError& error)
  {
    throw InputError(file, key, error.what());
  }
  return composition;
}

YAML::Node parse(const std::string& file)
{
  std::ifstream stream = openInputFile(file, "give a file of materials as config/xray/materials.yaml");
  return parseYamlText({std::istreambuf_iterator<char>(stream), {}}, file);
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
  const YAML::Node root = parse(file);
  if (!root.IsMap() || root.size() == 0)
    throw InputError(file, "", "must map the name of each material to density and composition");
  MaterialLibrary library;
  library.file_ = file;
  for (const auto& entry : root)
  {
    const auto name = entry.first.as<std::string>();
    const YAML::Node& node = entry.second;
    if (!node.IsMap())
      throw InputError(file, name, "must contain density and composition");
    if (node["mass_attenuation"])
      throw InputError(file, name + ".mass_attenuation", "is not used; give the composition instead");
    Material material;
    const double density = positiveNumber(node["density"], file, name + ".density");
    library.judge(name + ".density", quantities::kMaterialDensity, density);
    material.density = density * kGramPerCubicCentimetre;
    material.composition = readComposition(node["composition"], file, name + ".composition");
    library.materials_[name] = material;
  }
  return library;
}

void MaterialLibrary::judge(const std::string& key, const Quantity& quantity, double value)
{
  const Plausibility result = plausibility(quantity, value);
  if (result == Plausibility::kImpossible)
    throw InputError(file_, key, plausibilityMessage(quantity, value));
  if (result == Plausibility::kUnusual)
    warnings_.push_back(file_ + ": " + key + ": " + plausibilityMessage(quantity, value));
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
