#pragma once

#include <string>

namespace endovascular_sim::contrast
{

constexpr double kStrongestMedium = 400.0;                      ///< iodine of a medium for vessels, iomeprol [kg/m³]
constexpr double kLeastViscosity = 5e-4, kMostViscosity = 0.1;  ///< of a medium [Pa·s]
constexpr double kLongestRise = 10.0;                           ///< of the rate of an injection [s]

/** Injection of contrast medium. */
struct Injection
{
  double volume = 0.0;         ///< [m³]
  double rate = 0.0;           ///< after the rise [m³/s]
  double rise = 0.0;           ///< time in which the rate rises linearly from zero [s]
  double concentration = 0.0;  ///< iodine of the medium [kg/m³], which is mgI/ml
  double viscosity = 0.0;      ///< of the medium at 37 °C [Pa·s]

  /** Volume that has left the syringe after a time [m³]. @param time since the beginning [s] */
  double volumeAfter(double time) const;
  double duration() const;  ///< [s]
};

/** Syringe of an injection. */
struct Syringe
{
  const char* name;
  double capacity;  ///< [m³]
  double fastest;   ///< largest rate [m³/s]
};

/** Syringe in the operator's hand: 12 ml, the usual size for coronary arteries; 10 ml/s are more than a thumb gives
 *  through a catheter. */
constexpr Syringe kHandSyringe{"hand syringe", 12e-6, 10e-6};

/** Syringe of a power injector: 150 ml at up to 40 ml/s, as angiographic injectors have. */
constexpr Syringe kPumpSyringe{"pump", 150e-6, 40e-6};

/** Reason for which an injection is impossible, with the remedy; empty without one. Positive and finite volume, rate,
 *  concentration and viscosity are required, a rise that the volume outlasts, at most 400 mgI/ml, and what the syringe
 *  gives.
 *  @param left what the syringe holds [m³] */
std::string refusalOf(const Injection& injection, const Syringe& syringe, double left);
std::string refusalOf(const Injection& injection, const Syringe& syringe);  ///< of a full syringe

}  // namespace endovascular_sim::contrast
