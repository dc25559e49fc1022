#pragma once

#include <optional>
#include <string>
#include <vector>

namespace endovascular_sim
{

/** Kind of a quantity; selects the units in which users write it by mistake. */
enum class Dimension
{
  kLength,
  kDiameter,
  kRadius,  ///< of an instrument, whose size is known by its diameter: French and inches are refused
  kCurvature,
  kAngle,
  kTime,
  kFrequency,
  kSpeed,
  kAngularSpeed,
  kAcceleration,
  kDensity,
  kForce,
  kTorque,
  kLineLoad,
  kPressure,
  kModulus,
  kFlexuralRigidity,
  kStiffness,
  kFraction,
  kEnergy,
  kConcentration,
  kGramDensity,
  kVolume,
  kVolumeFlow,
  kOther,
};

/** Physical quantity of an input value, with the magnitudes that occur in practice.
 *
 *  A magnitude outside [low, high] is unusual and causes a warning. A magnitude outside [lowest, highest] is rejected.
 *  Zero and infinity are not judged; the validity range of a key excludes them where they are invalid. */
struct Quantity
{
  const char* name;  ///< plural noun for messages, e.g. "balloon pressures"
  const char* unit;  ///< unit of the value; "1" for a pure number
  Dimension dimension;
  double low;      ///< smallest usual magnitude
  double high;     ///< largest usual magnitude
  double lowest;   ///< smallest accepted magnitude
  double highest;  ///< largest accepted magnitude
};

/** Unit in which a value may have been written by mistake. */
struct OtherUnit
{
  const char* name;
  double factor;  ///< value of the unit in the unit of the quantity
};

/** Units other than the quantity's own, the most frequent mistake first. */
const std::vector<OtherUnit>& otherUnits(Dimension dimension);

enum class Plausibility
{
  kUsual,
  kUnusual,
  kImpossible,
};

Plausibility plausibility(const Quantity& quantity, double value);

/** Unit that converts a value into a usual magnitude. Empty if the value is usual, or if no unit does. */
std::optional<OtherUnit> likelyUnit(const Quantity& quantity, double value);

/** Question for the likely unit, e.g. "did you mean 12 atm = 1.216e+06 Pa?"; empty without a likely unit. */
std::string unitQuestion(const Quantity& quantity, double value);

/** Description of an unusual or impossible value: "is 12: did you mean 12 atm = 1.216e+06 Pa? balloon pressures are in
 *  Pa, usually between 1000 and 4e+06". An impossible value adds the accepted limit. */
std::string plausibilityMessage(const Quantity& quantity, double value);

/** Interval in words, e.g. "0.001 to 4" or "at most 100". */
std::string intervalText(double low, double high);

}  // namespace endovascular_sim
