#include "common/written_unit.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/text/words.h"

namespace endovascular_sim
{
namespace
{

/** Other spellings of the units of otherUnits(), both without special characters. */
const std::vector<std::pair<std::string, std::string>> kSpellings = {
    {"in", "inches"}, {"inch", "inches"}, {"\"", "inches"}, {"F", "Fr"},        {"French", "Fr"},
    {"N/mm2", "MPa"}, {"mNm", "Nmm"},     {"°", "deg"},     {"degrees", "deg"}, {"g/cc", "g/cm3"}};

/** Dimension with its name, and the unit of its quantities. */
struct NamedDimension
{
  Dimension dimension;
  const char* name;
  const char* unit;
};

const std::vector<NamedDimension> kDimensions = {{Dimension::kLength, "length", "m"},
                                                 {Dimension::kDiameter, "diameter", "m"},
                                                 {Dimension::kCurvature, "curvature", "1/m"},
                                                 {Dimension::kAngle, "angle", "rad"},
                                                 {Dimension::kTime, "time", "s"},
                                                 {Dimension::kFrequency, "frequency", "Hz"},
                                                 {Dimension::kSpeed, "speed", "m/s"},
                                                 {Dimension::kAngularSpeed, "angular speed", "rad/s"},
                                                 {Dimension::kAcceleration, "acceleration", "m/s²"},
                                                 {Dimension::kDensity, "density", "kg/m³"},
                                                 {Dimension::kForce, "force", "N"},
                                                 {Dimension::kTorque, "torque", "N·m"},
                                                 {Dimension::kLineLoad, "force per length", "N/m"},
                                                 {Dimension::kPressure, "pressure", "Pa"},
                                                 {Dimension::kModulus, "modulus", "Pa"},
                                                 {Dimension::kFlexuralRigidity, "stiffness", "N·m²"},
                                                 {Dimension::kEnergy, "energy", "keV"},
                                                 {Dimension::kConcentration, "concentration", "mgI/ml"},
                                                 {Dimension::kVolume, "volume", "m³"},
                                                 {Dimension::kVolumeFlow, "volume per time", "m³/s"}};

void replaceAll(std::string& text, const std::string& from, const std::string& to)
{
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/** Unit in ASCII, without blanks and signs of multiplication: equal units have equal texts. */
std::string plain(std::string unit)
{
  const std::vector<std::pair<std::string, std::string>> characters = {
      {" ", ""}, {"·", ""}, {"⋅", ""}, {"*", ""}, {".", ""}, {"^", ""}, {"²", "2"}, {"³", "3"}, {"µ", "u"}, {"μ", "u"}};
  for (const auto& [from, to] : characters)
    replaceAll(unit, from, to);
  for (const auto& [spelling, name] : kSpellings)
    if (unit == spelling)
      return name;
  return unit;
}

/** Units of a dimension beside the quantity's own. A modulus is a pressure. */
std::vector<OtherUnit> unitsOf(Dimension dimension)
{
  std::vector<OtherUnit> units = otherUnits(dimension);
  if (dimension == Dimension::kModulus)
    for (const OtherUnit& unit : otherUnits(Dimension::kPressure))
      units.push_back(unit);
  if (dimension == Dimension::kPressure)
    for (const OtherUnit& unit : otherUnits(Dimension::kModulus))
      units.push_back(unit);
  return units;
}

/** Value of a unit, by its plain name, in the unit of a dimension. */
std::optional<double> valueOf(Dimension dimension, const std::string& own_unit, const std::string& plain_name)
{
  if (plain_name == plain(own_unit))
    return 1.0;
  for (const OtherUnit& unit : unitsOf(dimension))
    if (plain(unit.name) == plain_name)
      return unit.factor;
  return std::nullopt;
}

}  // namespace

std::optional<double> unitValue(const Quantity& quantity, const std::string& unit)
{
  return valueOf(quantity.dimension, quantity.unit, plain(unit));
}

std::string unitRemedy(const Quantity& quantity, const std::string& unit)
{
  std::string of_the_unit;
  if (quantity.dimension == Dimension::kForce && (unit == "g" || unit == "grams"))
    of_the_unit = unit + " is a mass: write the gram-force of a data sheet as gf; ";
  for (const NamedDimension& named : kDimensions)
    if (of_the_unit.empty() && valueOf(named.dimension, named.unit, plain(unit)))
      of_the_unit = unit + " is a unit of " + named.name + "; ";
  if (of_the_unit.empty())
    of_the_unit = "\"" + unit + "\" is no known unit; ";
  const std::string advice =
      quantity.dimension == Dimension::kRadius ? "; give the size of a data sheet by the key of the diameter" : "";
  const bool is_pure = std::string(quantity.unit) == "1";
  std::vector<std::string> names;
  if (!is_pure)
    names.emplace_back(quantity.unit);
  for (const OtherUnit& other : unitsOf(quantity.dimension))
    if (const std::string name = other.name; std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return of_the_unit + quantity.name +
         (names.empty() ? " have no unit: give a number"
                        : " are in " + listed(names) + (is_pure ? ", or have none" : "") + advice);
}

}  // namespace endovascular_sim
