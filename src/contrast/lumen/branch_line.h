#pragma once

#include <vector>

#include "contrast/lumen/cell_complex.h"
#include "geometry/polyline.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::contrast
{

/** Centreline of a branch with its radii, by arc length. */
class BranchLine
{
public:
  /** @throws InputError for a branch without length, or with a radius missing */
  explicit BranchLine(const vessel::CentrelineBranch& branch);

  const geometry::Polyline& line() const { return line_; }
  double length() const { return line_.length(); }                              ///< [m]
  double radiusAt(double arc) const { return line_.interpolate(radii_, arc); }  ///< [m]

  /** Plane normal to the centreline. Its normal is a chord of one radius, against noise of the points. */
  CutPlane planeAt(double arc) const;

private:
  geometry::Polyline line_;
  std::vector<double> radii_;  ///< at the points of line_ [m]
};

}  // namespace endovascular_sim::contrast
