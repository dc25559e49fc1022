#include "fluoroscopy/attenuation.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/quantities.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kSquareCentimetrePerGram = 0.1;    // [m²/kg]
constexpr double kGramPerCubicCentimetre = 1000.0;  // [kg/m³]

double positiveNumber(const YAML::Node& node, const std::string& file, const std::string& key)
{
  double value = 0.0;
  if (!node || !YAML::convert<double>::decode(node, value) || !std::isfinite(value) || value <= 0.0)
    throw InputError(file, key, "must be a positive number");
  return value;
}

std::vector<double> positiveNumbers(const YAML::Node& node, const std::string& file, const std::string& key)
{
  if (!node || !node.IsSequence() || node.size() < 2)
    throw InputError(file, key, "must be a list of at least two positive numbers");
  std::vector<double> values;
  for (std::size_t i = 0; i < node.size(); ++i)
    values.push_back(positiveNumber(node[i], file, key + "[" + std::to_string(i) + "]"));
  return values;
}

YAML::Node parse(const std::string& file)
{
  try
  {
    return YAML::LoadFile(file);
  }
  catch (const YAML::Exception& error)
  {
    throw InputError(file, "", std::string("cannot be read as YAML: ") + error.what());
  }
}

}  // namespace

AttenuationTable AttenuationTable::load(const std::string& file)
{
  const YAML::Node root = parse(file);
  if (!root.IsMap() || root.size() == 0)
    throw InputError(file, "", "must map the name of each material to density, energy and mass_attenuation");
  AttenuationTable table;
  table.file_ = file;
  for (const auto& entry : root)
  {
    const auto name = entry.first.as<std::string>();
    const YAML::Node& node = entry.second;
    if (!node.IsMap())
      throw InputError(file, name, "must contain density, energy and mass_attenuation");
    Material material;
    material.density = positiveNumber(node["density"], file, name + ".density") * kGramPerCubicCentimetre;
    material.energy = positiveNumbers(node["energy"], file, name + ".energy");
    material.mass = positiveNumbers(node["mass_attenuation"], file, name + ".mass_attenuation");
    if (material.mass.size() != material.energy.size())
      throw InputError(file, name + ".mass_attenuation", "must have one value per energy");
    if (!std::is_sorted(material.energy.begin(), material.energy.end()))
      throw InputError(file, name + ".energy", "must increase");
    table.judge(name + ".density", quantities::kMaterialDensity, material.density / kGramPerCubicCentimetre);
    table.judge(name + ".energy", quantities::kTableEnergy, material.energy.front());
    table.judge(name + ".energy", quantities::kTableEnergy, material.energy.back());
    for (const double value : material.mass)
      table.judge(name + ".mass_attenuation", quantities::kMassAttenuation, value);
    for (double& value : material.mass)
      value *= kSquareCentimetrePerGram;
    table.materials_[name] = material;
  }
  return table;
}

void AttenuationTable::judge(const std::string& key, const Quantity& quantity, double value)
{
  const Plausibility result = plausibility(quantity, value);
  if (result == Plausibility::kImpossible)
    throw InputError(file_, key, plausibilityMessage(quantity, value));
  if (result == Plausibility::kUnusual)
    warnings_.push_back(file_ + ": " + key + ": " + plausibilityMessage(quantity, value));
}

const AttenuationTable::Material& AttenuationTable::find(const std::string& material) const
{
  const auto found = materials_.find(material);
  if (found == materials_.end())
    throw InputError(file_, material, "missing; add density, energy and mass_attenuation of this material");
  return found->second;
}

double AttenuationTable::mass(const std::string& material, double energy) const
{
  const Material& table = find(material);
  if (!(energy >= table.energy.front() && energy <= table.energy.back()))
    throw InputError(file_, material + ".energy",
                     "does not include " + std::to_string(energy) + " keV; use an energy between " +
                         std::to_string(table.energy.front()) + " and " + std::to_string(table.energy.back()));
  const auto above = std::upper_bound(table.energy.begin(), table.energy.end(), energy);
  if (above == table.energy.end())
    return table.mass.back();
  const auto k = static_cast<std::size_t>(above - table.energy.begin());
  const double fraction = std::log(energy / table.energy[k - 1]) / std::log(table.energy[k] / table.energy[k - 1]);
  return table.mass[k - 1] * std::pow(table.mass[k] / table.mass[k - 1], fraction);
}

double AttenuationTable::linear(const std::string& material, double energy) const
{
  return mass(material, energy) * find(material).density;
}

double AttenuationTable::contrast(double iodine, double energy) const
{
  return linear("blood", energy) + iodine * mass("iodine", energy);  // 1 mg/ml = 1 kg/m³
}

}  // namespace endovascular_sim::fluoroscopy
