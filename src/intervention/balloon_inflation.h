#pragma once

#include <utility>

#include "instrument/balloon.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** A balloon driven by an inflator: pressure, diameter, rupture. */
class BalloonInflation
{
public:
  explicit BalloonInflation(instrument::Balloon balloon) : balloon_(std::move(balloon)) {}

  enum class Event
  {
    kNone,
    kAboveRated,  ///< the pressure has just exceeded the rated burst pressure
    kBurst,       ///< it has just exceeded the burst pressure: the balloon is empty from now on
  };

  /** Advances by @p dt [s]: the pressure follows the inflator's @p commanded one [Pa, above that of the blood] as
   *  dp/dt = (commanded − p)/τ with the balloon's time constants of filling and emptying, solved exactly. */
  Event step(double dt, double commanded);

  double pressure() const { return pressure_; }           ///< [Pa]
  double peakPressure() const { return peak_pressure_; }  ///< so far [Pa]
  bool burst() const { return burst_; }
  double diameter() const { return balloon_.diameterAt(pressure_); }  ///< where nothing holds it [m]
  const instrument::Balloon& balloon() const { return balloon_; }

  /** Radius of the free balloon at a distance from the catheter's tip [m]; 0 where there is none. A cylinder between
   *  cones that are as long as the labelled diameter (assumed; a slope of about 1 in 2). */
  double radiusAt(double from_tip) const { return radiusOf(diameter(), from_tip); }
  /** The same of the folded balloon [m]. */
  double foldedRadiusAt(double from_tip) const { return radiusOf(balloon_.folded_diameter, from_tip); }

  /** The distances from the tip between which radiusAt() is positive [m]. */
  double begin() const { return balloon_.from_tip - coneLength(); }
  double end() const { return balloon_.from_tip + balloon_.length + coneLength(); }

  void archive(Archive& archive);  ///< saves or loads all that changes

private:
  double radiusOf(double diameter, double from_tip) const;
  double coneLength() const { return balloon_.nominalDiameter(); }

  instrument::Balloon balloon_;
  double pressure_ = 0.0;
  double peak_pressure_ = 0.0;
  bool burst_ = false;
};

}  // namespace endovascular_sim::intervention
