#include "common/quantity.h"

#include <cmath>
#include <limits>

#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim
{
namespace
{

constexpr double kUnbounded = std::numeric_limits<double>::max();
using units::kAtmosphere;
using units::kDegree;
using units::kFrench;
using units::kInch;

bool isJudged(double value)
{
  return std::isfinite(value) && value != 0.0;
}

std::string withUnit(double value, const Quantity& quantity)
{
  return std::string(quantity.unit) == "1" ? shortNumber(value, 4) : shortNumber(value, 4) + " " + quantity.unit;
}

}  // namespace

const std::vector<OtherUnit>& otherUnits(Dimension dimension)
{
  static const std::vector<OtherUnit> length = {{"mm", 1e-3}, {"cm", 1e-2}, {"µm", 1e-6}, {"inches", kInch}};
  static const std::vector<OtherUnit> diameter = {{"mm", 1e-3}, {"Fr", kFrench}, {"inches", kInch}, {"µm", 1e-6}};
  static const std::vector<OtherUnit> radius = {{"mm", 1e-3}, {"cm", 1e-2}, {"µm", 1e-6}};
  static const std::vector<OtherUnit> curvature = {{"1/mm", 1e3}, {"1/cm", 1e2}};
  static const std::vector<OtherUnit> angle = {{"deg", kDegree}};
  static const std::vector<OtherUnit> time = {{"ms", 1e-3}, {"µs", 1e-6}, {"min", 60.0}};
  static const std::vector<OtherUnit> frequency = {{"1/min", 1.0 / 60.0}, {"kHz", 1e3}, {"mHz", 1e-3}};
  static const std::vector<OtherUnit> speed = {{"mm/s", 1e-3}, {"cm/s", 1e-2}};
  static const std::vector<OtherUnit> angular_speed = {{"deg/s", kDegree}, {"rpm", units::kPi / 30.0}};
  static const std::vector<OtherUnit> acceleration = {{"mm/s²", 1e-3}, {"cm/s²", 1e-2}, {"g", units::kGravity}};
  static const std::vector<OtherUnit> density = {{"g/cm³", 1e3}, {"g/m³", 1e-3}, {"kg/mm³", 1e9}};
  static const std::vector<OtherUnit> force = {{"mN", 1e-3}, {"gf", 1e-3 * units::kGravity}, {"µN", 1e-6}, {"kN", 1e3}};
  static const std::vector<OtherUnit> torque = {{"N·mm", 1e-3}, {"mN·mm", 1e-6}, {"N·cm", 1e-2}};
  static const std::vector<OtherUnit> line_load = {{"N/mm", 1e3}, {"mN/m", 1e-3}};
  static const std::vector<OtherUnit> pressure = {{"atm", kAtmosphere}, {"bar", 1e5},
                                                  {"kPa", 1e3},         {"mmHg", units::kMillimetreOfMercury},
                                                  {"MPa", 1e6},         {"psi", 6894.757}};
  static const std::vector<OtherUnit> modulus = {{"GPa", 1e9}, {"MPa", 1e6}, {"kPa", 1e3}};
  static const std::vector<OtherUnit> rigidity = {{"N·mm²", 1e-6}, {"N·cm²", 1e-4}};
  static const std::vector<OtherUnit> stiffness = {{"N/mm", 1e3}, {"mN/m", 1e-3}};
  static const std::vector<OtherUnit> fraction = {{"%", 1e-2}};
  static const std::vector<OtherUnit> energy = {{"eV", 1e-3}, {"MeV", 1e3}};
  static const std::vector<OtherUnit> concentration = {{"mgI/l", 1e-3}, {"gI/ml", 1e3}};
  static const std::vector<OtherUnit> gram_density = {{"kg/m³", 1e-3}};
  static const std::vector<OtherUnit> volume = {{"ml", 1e-6}, {"cm³", 1e-6}, {"l", 1e-3}, {"mm³", 1e-9}};
  static const std::vector<OtherUnit> volume_flow = {{"ml/s", 1e-6}, {"ml/min", 1e-6 / 60.0}, {"l/min", 1e-3 / 60.0}};
  static const std::vector<OtherUnit> none;
  switch (dimension)
  {
    case Dimension::kLength:
      return length;
    case Dimension::kDiameter:
      return diameter;
    case Dimension::kRadius:
      return radius;
    case Dimension::kCurvature:
      return curvature;
    case Dimension::kAngle:
      return angle;
    case Dimension::kTime:
      return time;
    case Dimension::kFrequency:
      return frequency;
    case Dimension::kSpeed:
      return speed;
    case Dimension::kAngularSpeed:
      return angular_speed;
    case Dimension::kAcceleration:
      return acceleration;
    case Dimension::kDensity:
      return density;
    case Dimension::kForce:
      return force;
    case Dimension::kTorque:
      return torque;
    case Dimension::kLineLoad:
      return line_load;
    case Dimension::kPressure:
      return pressure;
    case Dimension::kModulus:
      return modulus;
    case Dimension::kFlexuralRigidity:
      return rigidity;
    case Dimension::kStiffness:
      return stiffness;
    case Dimension::kFraction:
      return fraction;
    case Dimension::kEnergy:
      return energy;
    case Dimension::kConcentration:
      return concentration;
    case Dimension::kGramDensity:
      return gram_density;
    case Dimension::kVolume:
      return volume;
    case Dimension::kVolumeFlow:
      return volume_flow;
    case Dimension::kOther:
      break;
  }
  return none;
}

Plausibility plausibility(const Quantity& quantity, double value)
{
  const double magnitude = std::abs(value);
  if (!isJudged(value) || (magnitude >= quantity.low && magnitude <= quantity.high))
    return Plausibility::kUsual;
  const bool accepted = magnitude >= quantity.lowest && magnitude <= quantity.highest;
  return accepted ? Plausibility::kUnusual : Plausibility::kImpossible;
}

std::optional<OtherUnit> likelyUnit(const Quantity& quantity, double value)
{
  if (!isJudged(value) || plausibility(quantity, value) == Plausibility::kUsual)
    return std::nullopt;
  for (const OtherUnit& unit : otherUnits(quantity.dimension))
    if (plausibility(quantity, value * unit.factor) == Plausibility::kUsual)
      return unit;
  return std::nullopt;
}

std::string unitQuestion(const Quantity& quantity, double value)
{
  const std::optional<OtherUnit> unit = likelyUnit(quantity, value);
  if (!unit)
    return "";
  return "did you mean " + shortNumber(value, 4) + " " + unit->name + " = " + withUnit(value * unit->factor, quantity) +
         "?";
}

std::string plausibilityMessage(const Quantity& quantity, double value)
{
  const double magnitude = std::abs(value);
  const std::string question = unitQuestion(quantity, value);
  const std::string unit = std::string(quantity.unit) == "1" ? "" : std::string("in ") + quantity.unit + ", ";
  std::string message = "is " + shortNumber(value, 4) + ": " + question + (question.empty() ? "" : " ") +
                        quantity.name + " are " + unit + "usually " + intervalText(quantity.low, quantity.high);
  if (isJudged(value) && magnitude > quantity.highest)
    message += "; at most " + shortNumber(quantity.highest, 4) + " is accepted";
  if (isJudged(value) && magnitude < quantity.lowest)
    message += "; at least " + shortNumber(quantity.lowest, 4) + " is accepted";
  return message;
}

std::string intervalText(double low, double high)
{
  if (high >= kUnbounded)
    return low <= 0.0 ? "any" : "at least " + shortNumber(low, 4);
  return low <= 0.0 ? "at most " + shortNumber(high, 4) : shortNumber(low, 4) + " to " + shortNumber(high, 4);
}

}  // namespace endovascular_sim
