#pragma once

#include <vector>

namespace endovascular_sim::instrument
{

/** Balloon-expandable stent. Diameters are inner diameters unless noted. */
struct Stent
{
  /** Row of the foreshortening table. */
  struct Expansion
  {
    double diameter = 0.0;  ///< [m]
    double length = 0.0;    ///< [m]
  };

  double crimped_diameter = 0.0;     ///< outer diameter, crimped on the balloon [m]
  double nominal_diameter = 0.0;     ///< labelled diameter [m]
  double strut_thickness = 0.0;      ///< including the coating [m]
  double recoil = 0.0;               ///< acute recoil: relative loss of diameter at balloon deflation [1]
  std::vector<Expansion> expansion;  ///< foreshortening table, by increasing diameter

  /** Length at an inner diameter [m]: linear between the rows of the table, constant outside of it. */
  double lengthAt(double diameter) const;

  /** Inner diameter after recoil from an expanded @p diameter [m]. */
  double afterRecoil(double diameter) const { return diameter * (1.0 - recoil); }

  /** Largest permitted diameter, the post-dilatation limit [m]. */
  double largestDiameter() const { return expansion.back().diameter; }

  /** Length crimped on the balloon [m]. */
  double crimpedLength() const { return expansion.front().length; }
};

}  // namespace endovascular_sim::instrument
