#pragma once

#include <vector>

namespace endovascular_sim::instrument
{

/** Balloon of a balloon catheter. Pressures are transmural: relative to the blood pressure. */
struct Balloon
{
  /** Row of the manufacturer's compliance chart. */
  struct Compliance
  {
    double pressure = 0.0;  ///< [Pa]
    double diameter = 0.0;  ///< outer diameter of the unconstrained balloon [m]
  };

  double from_tip = 0.0;               ///< distance from the catheter's tip to the balloon's distal end [m]
  double length = 0.0;                 ///< length of the cylindrical part [m]
  double folded_diameter = 0.0;        ///< diameter wrapped around the shaft, without a stent [m]
  std::vector<Compliance> compliance;  ///< chart, by increasing pressure
  double nominal_pressure = 0.0;       ///< pressure at the labelled diameter [Pa]
  double rated_burst_pressure = 0.0;   ///< pressure that the manufacturer guarantees [Pa]
  double burst_pressure = 0.0;         ///< pressure at which this balloon ruptures [Pa]
  double inflation_time = 0.0;         ///< time constant of the pressure during inflation [s]
  double deflation_time = 0.0;         ///< time constant of the pressure during deflation [s]

  /** Diameter of the unconstrained balloon [m]: piecewise linear through (0, folded diameter) and the rows of the
   *  chart, extrapolated beyond the last row.
   *  @param pressure [Pa]; the folded diameter at vacuum */
  double diameterAt(double pressure) const;

  /** Labelled diameter [m]. */
  double nominalDiameter() const { return diameterAt(nominal_pressure); }
};

}  // namespace endovascular_sim::instrument
