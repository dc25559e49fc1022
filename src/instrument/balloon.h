#pragma once

#include <vector>

namespace endovascular_sim::instrument
{

/** The balloon of a balloon catheter. Pressures are above that of the blood around it. */
struct Balloon
{
  /** One row of the manufacturer's compliance chart. */
  struct Compliance
  {
    double pressure = 0.0;  ///< [Pa]
    double diameter = 0.0;  ///< outer, unconstrained [m]
  };

  double from_tip = 0.0;         ///< from the catheter's tip to the balloon's distal end [m]
  double length = 0.0;           ///< of its cylinder [m]
  double folded_diameter = 0.0;  ///< wrapped around the shaft, without a stent [m]
  std::vector<Compliance> compliance;
  double nominal_pressure = 0.0;      ///< at which the balloon has its labelled diameter [Pa]
  double rated_burst_pressure = 0.0;  ///< that it is guaranteed to stand [Pa]
  double burst_pressure = 0.0;        ///< at which it ruptures [Pa]
  double inflation_time = 0.0;        ///< time constant with which its pressure follows the inflator's [s]
  double deflation_time = 0.0;        ///< the same when the inflator draws back [s]

  /** Diameter of the free balloon [m]: linear between the rows of the chart, from the folded diameter at no pressure to
   *  the first row, and beyond the last row with the slope before it.
   *  @param pressure [Pa]; a vacuum folds it */
  double diameterAt(double pressure) const;

  /** Labelled diameter [m]. */
  double nominalDiameter() const { return diameterAt(nominal_pressure); }
};

}  // namespace endovascular_sim::instrument
