#pragma once

#include <vector>

namespace endovascular_sim::instrument
{

/** A balloon-expandable stent. Diameters are inner ones unless noted. */
struct Stent
{
  /** Length at a diameter: stents shorten as they open. */
  struct Expansion
  {
    double diameter = 0.0;  ///< [m]
    double length = 0.0;    ///< [m]
  };

  double crimped_diameter = 0.0;  ///< outer, on its balloon [m]
  double nominal_diameter = 0.0;  ///< labelled [m]
  double strut_thickness = 0.0;   ///< with the coating [m]
  double recoil = 0.0;            ///< share of the diameter that is lost when the balloon is deflated [1]
  std::vector<Expansion> expansion;

  /** Length at an inner diameter [m]: linear between the rows, the outermost beyond them. */
  double lengthAt(double diameter) const;

  /** Inner diameter after deflation of a balloon that has opened it to @p diameter [m]. */
  double afterRecoil(double diameter) const { return diameter * (1.0 - recoil); }

  /** Largest diameter to which it may be opened [m]. */
  double largestDiameter() const { return expansion.back().diameter; }

  /** Length on the balloon [m]. */
  double crimpedLength() const { return expansion.front().length; }
};

}  // namespace endovascular_sim::instrument
