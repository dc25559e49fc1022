#pragma once

#include <utility>

#include "instrument/balloon.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** Inflation state of a balloon: pressure, diameter, rupture. */
class BalloonInflation
{
public:
  explicit BalloonInflation(instrument::Balloon balloon) : balloon_(std::move(balloon)) {}

  enum class Event
  {
    kNone,
    kAboveRated,  ///< first step with a pressure above the rated burst pressure
    kBurst,       ///< first step with a pressure above the burst pressure; the balloon stays empty
  };

  /** Advances the pressure by the exact solution of dp/dt = (p_c − p)/τ with the inflation or deflation time constant
   *  τ.
   *  @param dt time step [s]
   *  @param commanded transmural pressure p_c commanded at the inflator [Pa] */
  Event step(double dt, double commanded);

  double pressure() const { return pressure_; }           ///< [Pa]
  double peakPressure() const { return peak_pressure_; }  ///< largest pressure since construction [Pa]
  bool burst() const { return burst_; }
  double diameter() const { return balloon_.diameterAt(pressure_); }  ///< unconstrained [m]
  const instrument::Balloon& balloon() const { return balloon_; }

  /** Radius of the unconstrained balloon at a distance from the catheter's tip [m]; 0 outside of the balloon. The shape
   *  is a cylinder between two cones. Each cone is as long as the labelled diameter (assumed; slope of about 1/2). */
  double radiusAt(double from_tip) const { return radiusOf(diameter(), from_tip); }
  /** Radius of the folded balloon at a distance from the catheter's tip [m]. */
  double foldedRadiusAt(double from_tip) const { return radiusOf(balloon_.folded_diameter, from_tip); }

  /** Distances from the tip between which radiusAt() is positive [m]. */
  double begin() const { return balloon_.from_tip - coneLength(); }
  double end() const { return balloon_.from_tip + balloon_.length + coneLength(); }

  void archive(Archive& archive);  ///< saves or loads the state

private:
  double radiusOf(double diameter, double from_tip) const;
  double coneLength() const { return balloon_.nominalDiameter(); }

  instrument::Balloon balloon_;
  double pressure_ = 0.0;
  double peak_pressure_ = 0.0;
  bool burst_ = false;
};

}  // namespace endovascular_sim::intervention
