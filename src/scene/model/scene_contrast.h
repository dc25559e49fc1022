#pragma once

#include <limits>
#include <string>
#include <vector>

#include "contrast/injection/injection.h"

namespace endovascular_sim::scene
{

/** Syringe that the contrast medium leaves. */
enum class SyringeKind
{
  kHand,  ///< contrast::kHandSyringe
  kPump,  ///< contrast::kPumpSyringe
};

/** Injection at a time of the scene. */
struct InjectionScene
{
  double at = 0.0;      ///< beginning [s]
  double volume = 0.0;  ///< [m³]
  double rate = 0.0;    ///< after the rise [m³/s]
  double rise = 0.3;    ///< [s]
};

/** Contrast medium that is injected through an instrument of the scene. */
struct ContrastScene
{
  std::string instrument;        ///< name of the one with the lumen
  double concentration = 350.0;  ///< iodine of the medium [kg/m³]
  double viscosity = 10.4e-3;    ///< of the medium at 37 °C [Pa·s]
  SyringeKind kind = SyringeKind::kHand;
  std::vector<InjectionScene> injections;  ///< ascending in time, without overlap

  const contrast::Syringe& syringe() const;

  /** Injection of the scene's medium, or of another one, whose viscosity is contrast::mediumViscosity().
   *  @param volume [m³]  @param rate [m³/s]  @param rise [s]
   *  @param iodine of the medium [kg/m³]; NaN: that of the scene */
  contrast::Injection injection(double volume, double rate, double rise,
                                double iodine = std::numeric_limits<double>::quiet_NaN()) const;
};

}  // namespace endovascular_sim::scene
